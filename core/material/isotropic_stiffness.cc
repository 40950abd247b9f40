#include "core/material/isotropic_stiffness.h"

namespace cleave {
namespace {

// Diagonalises the symmetric `a` in place by cyclic Jacobi rotations, gathered in `v`. Quadratic
// convergence: four sweeps bring any 3x3 matrix to rounding, most need three.
void DiagonaliseSymmetric(Matrix3<Double4>& a, Matrix3<Double4>& v) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) v(i, j) = Splat(i == j ? 1 : 0);
  }
  for (int sweep = 0; sweep < 6; ++sweep) {
    const Double4 off = a(0, 1) * a(0, 1) + a(0, 2) * a(0, 2) + a(1, 2) * a(1, 2);
    const Double4 diagonal = a(0, 0) * a(0, 0) + a(1, 1) * a(1, 1) + a(2, 2) * a(2, 2);
    if (!Any(off > 1e-32 * diagonal)) return;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        const int r = 3 - p - q;
        const Double4 difference = a(q, q) - a(p, p);
        const Double4 twice = 2.0 * a(p, q);
        const Double4 root = Sqrt(difference * difference + twice * twice);
        const Double4 size = Abs(difference) + root + 1e-300;
        const Double4 t = (difference < 0 ? -twice : twice) / size;
        const Double4 c = 1.0 / Sqrt(1.0 + t * t);
        const Double4 s = t * c;
        a(p, p) -= t * a(p, q);
        a(q, q) += t * a(p, q);
        a(p, q) = a(q, p) = Splat(0);
        const Double4 rp = c * a(r, p) - s * a(r, q);
        const Double4 rq = s * a(r, p) + c * a(r, q);
        a(r, p) = a(p, r) = rp;
        a(r, q) = a(q, r) = rq;
        for (int k = 0; k < 3; ++k) {
          const Double4 vp = c * v(k, p) - s * v(k, q);
          v(k, q) = s * v(k, p) + c * v(k, q);
          v(k, p) = vp;
        }
      }
    }
  }
}

// Swaps columns p and q where the second key is larger, turning one round so that a rotation stays
// a rotation.
void SortColumns(Double4 key[3], Matrix3<Double4>& v, int p, int q) {
  const Int64x4 swap = key[q] > key[p];
  const Double4 larger = swap ? key[q] : key[p];
  key[q] = swap ? key[p] : key[q];
  key[p] = larger;
  for (int k = 0; k < 3; ++k) {
    const Double4 first = swap ? v(k, q) : v(k, p);
    v(k, q) = swap ? -v(k, p) : v(k, q);
    v(k, p) = first;
  }
}

}  // namespace

SignedSvd ComputeSvd(const Matrix3<Double4>& g) {
  SignedSvd svd;
  Matrix3<Double4> c;  // F^T F - I, whose eigenvalues are s^2 - 1
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      c(i, j) = c(j, i) =
          g(i, j) + g(j, i) + (g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j));
    }
  }
  DiagonaliseSymmetric(c, svd.v);
  Double4 key[3] = {c(0, 0), c(1, 1), c(2, 2)};
  SortColumns(key, svd.v, 0, 1);
  SortColumns(key, svd.v, 0, 2);
  SortColumns(key, svd.v, 1, 2);

  Matrix3<Double4> b = g * svd.v;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) b(i, j) += svd.v(i, j);
  }
  Matrix3<Double4>& u = svd.u;
  const Double4 length0 = Sqrt(b(0, 0) * b(0, 0) + b(1, 0) * b(1, 0) + b(2, 0) * b(2, 0));
  const Int64x4 collapsed = !(length0 > 1e-150);
  for (int i = 0; i < 3; ++i) u(i, 0) = collapsed ? Splat(i == 0 ? 1 : 0) : b(i, 0) / length0;

  // The second direction, made exactly square to the first; any such direction where b vanishes.
  const Double4 along = u(0, 0) * b(0, 1) + u(1, 0) * b(1, 1) + u(2, 0) * b(2, 1);
  Double4 w[3];
  for (int i = 0; i < 3; ++i) w[i] = b(i, 1) - along * u(i, 0);
  const Double4 length1 = Sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const Int64x4 line = collapsed | !(length1 > 1e-12 * length0);
  const Int64x4 steep = Abs(u(0, 0)) > 0.6;
  const Double4 square[3] = {steep ? -u(2, 0) : Splat(0), steep ? Splat(0) : u(2, 0),
                             steep ? u(0, 0) : -u(1, 0)};
  const Double4 square_length =
      Sqrt(square[0] * square[0] + square[1] * square[1] + square[2] * square[2]);
  for (int i = 0; i < 3; ++i) u(i, 1) = line ? square[i] / square_length : w[i] / length1;

  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    u(i, 2) = u(j, 0) * u(k, 1) - u(k, 0) * u(j, 1);
  }
  for (int k = 0; k < 3; ++k) {
    svd.s[k] = u(0, k) * b(0, k) + u(1, k) * b(1, k) + u(2, k) * b(2, k);
    svd.strain[k] = svd.s[k] > 0.5 ? key[k] / (svd.s[k] + 1.0) : svd.s[k] - 1.0;
  }
  return svd;
}

Matrix3<Double4> FromPrincipal(const SignedSvd& svd, const Double4 values[3]) {
  Matrix3<Double4> result;
  for (int i = 0; i < 3; ++i) {
    const Double4 row[3] = {svd.u(i, 0) * values[0], svd.u(i, 1) * values[1],
                            svd.u(i, 2) * values[2]};
    for (int j = 0; j < 3; ++j)
      result(i, j) = row[0] * svd.v(j, 0) + row[1] * svd.v(j, 1) + row[2] * svd.v(j, 2);
  }
  return result;
}

void ProjectToSemidefinite(StiffnessSpectrum& spectrum) {
  for (int k = 0; k < 3; ++k) {
    spectrum.symmetric[k] = Max(spectrum.symmetric[k], Splat(0));
    spectrum.skew[k] = Max(spectrum.skew[k], Splat(0));
  }
  // Positive leading minors: nothing to do, as in all but strongly deformed tets.
  auto& a = spectrum.axial;
  const Double4 minor2 = a[0][0] * a[1][1] - a[0][1] * a[0][1];
  const Double4 determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[1][2]) -
                              a[0][1] * (a[0][1] * a[2][2] - a[1][2] * a[0][2]) +
                              a[0][2] * (a[0][1] * a[1][2] - a[1][1] * a[0][2]);
  const Int64x4 definite = (a[0][0] > 0) & (minor2 > 0) & (determinant > 0);
  if (!Any(~definite)) return;
  Matrix3<Double4> values, vectors;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) values(i, j) = a[i][j];
  }
  DiagonaliseSymmetric(values, vectors);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      Double4 sum = Splat(0);
      for (int k = 0; k < 3; ++k)
        sum += Max(values(k, k), Splat(0)) * vectors(i, k) * vectors(j, k);
      a[i][j] = a[j][i] = definite ? a[i][j] : sum;
    }
  }
}

}  // namespace cleave

#include "core/material/isotropic_stiffness.h"

#include <cmath>

namespace cleave {
namespace {

// Diagonalises the symmetric `a` in place by cyclic Jacobi rotations, gathered in `v`. Quadratic
// convergence: four sweeps bring any 3x3 matrix to rounding, most need three.
template <typename T>
void DiagonaliseSymmetric(Matrix3<T>& a, Matrix3<T>& v) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) v(i, j) = Splat<T>(i == j ? 1 : 0);
  }
  const T kNegligible = Splat<T>(Lanes<T>::kRounding * Lanes<T>::kRounding);
  for (int sweep = 0; sweep < 6; ++sweep) {
    const T off = a(0, 1) * a(0, 1) + a(0, 2) * a(0, 2) + a(1, 2) * a(1, 2);
    const T diagonal = a(0, 0) * a(0, 0) + a(1, 1) * a(1, 1) + a(2, 2) * a(2, 2);
    if (!Any(off > kNegligible * diagonal)) return;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        const int r = 3 - p - q;
        const T difference = a(q, q) - a(p, p);
        const T twice = 2.0 * a(p, q);
        // Not less than either, even where the squares underflow.
        const T root = Max(Sqrt(difference * difference + twice * twice), Abs(twice));
        const T size = Abs(difference) + root + Splat<T>(Lanes<T>::kTiny);
        const T t = (difference < 0 ? -twice : twice) / size;
        const T c = 1.0 / Sqrt(1.0 + t * t);
        const T s = t * c;
        a(p, p) -= t * a(p, q);
        a(q, q) += t * a(p, q);
        a(p, q) = a(q, p) = Splat<T>(0);
        const T rp = c * a(r, p) - s * a(r, q);
        const T rq = s * a(r, p) + c * a(r, q);
        a(r, p) = a(p, r) = rp;
        a(r, q) = a(q, r) = rq;
        for (int k = 0; k < 3; ++k) {
          const T vp = c * v(k, p) - s * v(k, q);
          v(k, q) = s * v(k, p) + c * v(k, q);
          v(k, p) = vp;
        }
      }
    }
  }
}

// Swaps columns p and q where the second key is larger, turning one round so that a rotation stays
// a rotation.
template <typename T>
void SortColumns(T key[3], Matrix3<T>& v, int p, int q) {
  const auto swap = key[q] > key[p];
  const T larger = swap ? key[q] : key[p];
  key[q] = swap ? key[p] : key[q];
  key[p] = larger;
  for (int k = 0; k < 3; ++k) {
    const T first = swap ? v(k, q) : v(k, p);
    v(k, q) = swap ? -v(k, p) : v(k, q);
    v(k, p) = first;
  }
}

}  // namespace

template <typename T>
SignedSvd<T> ComputeSvd(const Matrix3<T>& g) {
  // Below these a length has no square, and a direction is rounding.
  const double kCollapsed = std::sqrt(Lanes<T>::kTiny);
  constexpr double kParallel = 64 * Lanes<T>::kRounding;
  SignedSvd<T> svd;
  Matrix3<T> c;  // F^T F - I, whose eigenvalues are s^2 - 1
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      c(i, j) = c(j, i) =
          g(i, j) + g(j, i) + (g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j));
    }
  }
  DiagonaliseSymmetric(c, svd.v);
  T key[3] = {c(0, 0), c(1, 1), c(2, 2)};
  SortColumns(key, svd.v, 0, 1);
  SortColumns(key, svd.v, 0, 2);
  SortColumns(key, svd.v, 1, 2);

  Matrix3<T> b = g * svd.v;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) b(i, j) += svd.v(i, j);
  }
  Matrix3<T>& u = svd.u;
  const T length0 = Sqrt(b(0, 0) * b(0, 0) + b(1, 0) * b(1, 0) + b(2, 0) * b(2, 0));
  const auto collapsed = !(length0 > Splat<T>(kCollapsed));
  for (int i = 0; i < 3; ++i) u(i, 0) = collapsed ? Splat<T>(i == 0 ? 1 : 0) : b(i, 0) / length0;

  // The second direction, made exactly square to the first; any such direction where b vanishes.
  const T along = u(0, 0) * b(0, 1) + u(1, 0) * b(1, 1) + u(2, 0) * b(2, 1);
  T w[3];
  for (int i = 0; i < 3; ++i) w[i] = b(i, 1) - along * u(i, 0);
  const T length1 = Sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const auto line = collapsed | !(length1 > Splat<T>(kParallel) * length0);
  const auto steep = Abs(u(0, 0)) > 0.625;
  const T square[3] = {steep ? -u(2, 0) : Splat<T>(0), steep ? Splat<T>(0) : u(2, 0),
                       steep ? u(0, 0) : -u(1, 0)};
  const T square_length =
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

template <typename T>
Matrix3<T> FromPrincipal(const SignedSvd<T>& svd, const T values[3]) {
  Matrix3<T> result;
  for (int i = 0; i < 3; ++i) {
    const T row[3] = {svd.u(i, 0) * values[0], svd.u(i, 1) * values[1], svd.u(i, 2) * values[2]};
    for (int j = 0; j < 3; ++j)
      result(i, j) = row[0] * svd.v(j, 0) + row[1] * svd.v(j, 1) + row[2] * svd.v(j, 2);
  }
  return result;
}

template <typename T>
void ProjectToSemidefinite(StiffnessSpectrum<T>& spectrum) {
  for (int k = 0; k < 3; ++k) {
    spectrum.symmetric[k] = Max(spectrum.symmetric[k], Splat<T>(0));
    spectrum.skew[k] = Max(spectrum.skew[k], Splat<T>(0));
  }
  // Positive leading minors: nothing to do, as in all but strongly deformed tets.
  auto& a = spectrum.axial;
  const T minor2 = a[0][0] * a[1][1] - a[0][1] * a[0][1];
  const T determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[1][2]) -
                        a[0][1] * (a[0][1] * a[2][2] - a[1][2] * a[0][2]) +
                        a[0][2] * (a[0][1] * a[1][2] - a[1][1] * a[0][2]);
  const auto definite = (a[0][0] > 0) & (minor2 > 0) & (determinant > 0);
  if (!Any(~definite)) return;
  Matrix3<T> values, vectors;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) values(i, j) = a[i][j];
  }
  DiagonaliseSymmetric(values, vectors);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      T sum = Splat<T>(0);
      for (int k = 0; k < 3; ++k)
        sum += Max(values(k, k), Splat<T>(0)) * vectors(i, k) * vectors(j, k);
      a[i][j] = a[j][i] = definite ? a[i][j] : sum;
    }
  }
}

template SignedSvd<Double4> ComputeSvd(const Matrix3<Double4>&);
template SignedSvd<Float8> ComputeSvd(const Matrix3<Float8>&);
template Matrix3<Double4> FromPrincipal(const SignedSvd<Double4>&, const Double4[3]);
template Matrix3<Float8> FromPrincipal(const SignedSvd<Float8>&, const Float8[3]);
template void ProjectToSemidefinite(StiffnessSpectrum<Double4>&);
template void ProjectToSemidefinite(StiffnessSpectrum<Float8>&);

}  // namespace cleave

#ifndef CLEAVE_CORE_MODEL_ELEMENT_BLOCKS_H_
#define CLEAVE_CORE_MODEL_ELEMENT_BLOCKS_H_

#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/mesh/incidence.h"
#include "core/model/batch_scatter.h"

namespace cleave {

// The element matrices of an isotropic energy: `scale` times its second derivative, by the shape
// gradients of vertices 1 to 3. In the frame of the singular values that derivative is sparse, so
// the blocks are built there from turned gradients and turned back. `others` add theirs to the
// block of an edge before it is stored. Source: method note, section 5.
template <typename T, typename Others>
void SetElementBlocks(const Matrix3<T>& shape_gradient, const T& scale, const SignedSvd<T>& svd,
                      const StiffnessSpectrum<T>& spectrum, const Others& others,
                      BatchBlocks<T>& out) {
  T gradient[4][3];  // of every vertex, in the frame of V
  for (int i = 0; i < 3; ++i) {
    for (int vertex = 1; vertex < 4; ++vertex) {
      const T* g = shape_gradient.m[vertex - 1];
      gradient[vertex][i] = g[0] * svd.v(0, i) + g[1] * svd.v(1, i) + g[2] * svd.v(2, i);
    }
    gradient[0][i] = -(gradient[1][i] + gradient[2][i] + gradient[3][i]);
  }
  // Of a pair of off-diagonal entries: how each follows itself and how it follows the other.
  // The minus sign of the block is taken in here, with the scale.
  T itself[3], other[3], axial[3][3];
  for (int k = 0; k < 3; ++k) {
    itself[k] = -0.5 * scale * (spectrum.symmetric[k] + spectrum.skew[k]);
    other[k] = -0.5 * scale * (spectrum.symmetric[k] - spectrum.skew[k]);
    for (int i = 0; i < 3; ++i) axial[k][i] = -scale * spectrum.axial[k][i];
  }
  for (size_t edge = 0; edge < 6; ++edge) {
    const T* a = gradient[kTetEdges[edge][0]];
    const T* b = gradient[kTetEdges[edge][1]];
    Matrix3<T> turned;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      turned(i, i) =
          axial[i][i] * a[i] * b[i] + itself[k] * (a[j] * b[j]) + itself[j] * (a[k] * b[k]);
      turned(i, j) = axial[i][j] * (a[i] * b[j]) + other[k] * (a[j] * b[i]);
      turned(j, i) = axial[j][i] * (a[j] * b[i]) + other[k] * (a[i] * b[j]);
    }
    const Matrix3<T> half = svd.u * turned;
    T block[9];
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        block[3 * column + row] = half(row, 0) * svd.u(column, 0) +
                                  half(row, 1) * svd.u(column, 1) + half(row, 2) * svd.u(column, 2);
      }
    }
    others.AddTo(edge, block);
    for (int k = 0; k < 9; ++k) out.block[edge][k] = block[k];
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_ELEMENT_BLOCKS_H_

#ifndef CLEAVE_TESTS_UNIT_CORE_MODEL_DENSE_TERM_H_
#define CLEAVE_TESTS_UNIT_CORE_MODEL_DENSE_TERM_H_

#include <Eigen/Dense>

#include "core/mesh/incidence.h"
#include "core/model/nodal_vector.h"
#include "core/model/tet_term.h"

namespace cleave {

// The forces of a term, three numbers a node.
inline Eigen::VectorXd DenseForces(TetTerm& term, const NodalVector& displacements) {
  NodalVector forces(displacements.size(), Splat(0));
  term.AddForces(displacements, forces);
  Eigen::VectorXd flat(static_cast<int>(3 * forces.size()));
  for (int i = 0; i < flat.size(); ++i) flat[i] = forces[static_cast<size_t>(i / 3)][i % 3];
  return flat;
}

// The matrix of a term, put together from its blocks of edges.
inline Eigen::MatrixXd DenseStiffness(TetTerm& term, const Incidence& incidence,
                                      const NodalVector& displacements, Curvature curvature) {
  EdgeBlocks blocks(EdgeBlocksSize(incidence.edge_count()), 0.0f);
  term.AddStiffness(displacements, curvature, blocks);
  const auto size = static_cast<int>(3 * displacements.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
    const int i = 3 * incidence.edges[edge][0], j = 3 * incidence.edges[edge][1];
    const Eigen::Matrix3d block =
        Eigen::Map<const Eigen::Matrix3f>(blocks.data() + 9 * edge).cast<double>();
    matrix.block<3, 3>(i, j) -= block;
    matrix.block<3, 3>(j, i) -= block.transpose();
    matrix.block<3, 3>(i, i) += block;
    matrix.block<3, 3>(j, j) += block.transpose();
  }
  return matrix;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_MODEL_DENSE_TERM_H_

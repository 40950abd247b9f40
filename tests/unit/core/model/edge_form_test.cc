// Equation 1 of the paper: nodal forces as tensions of edges. It must be the ordinary force of
// every law, with and without fibres, inverted or not (method note, section 1).

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_geometry.h"
#include "core/model/elastic_term.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

class EdgeForm : public ::testing::TestWithParam<ElasticLaw> {};

TEST_P(EdgeForm, IsTheForceOfTheStress) {
  constexpr double kYoungs = 1000;
  int upright = 0, inverted = 0;
  for (uint64_t sample = 0; upright < 100 || inverted < 100; ++sample) {
    uint64_t draw = 0;
    const auto random = [&] {
      return 2 * UniformDraw(7, RandomStream::kMeshJitter, sample, draw++) - 1;
    };
    TetMesh mesh;
    mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (Vec3& x : mesh.rest_positions) {
      for (double& coordinate : x) coordinate += 0.2 * random();
    }
    mesh.tets = {{0, 1, 2, 3}};
    const double volume = SignedVolume(CornersOf(mesh, 0));
    NodalVector displacements(4, Splat(0));
    Matrix3d rest, current;
    std::vector<Vector3d> now(4);
    for (size_t node = 0; node < 4; ++node) {
      const Vector3d x(mesh.rest_positions[node].data());
      now[node] = Vector3d(1.2 * random(), 1.2 * random(), 1.2 * random());
      for (int axis = 0; axis < 3; ++axis) displacements[node][axis] = now[node][axis] - x[axis];
      if (node == 0) continue;
      const auto column = static_cast<Eigen::Index>(node) - 1;
      rest.col(column) = x - Vector3d(mesh.rest_positions[0].data());
      current.col(column) = now[node] - now[0];
    }
    const Matrix3d gradient = current * rest.inverse();
    // At |J| near 0 the edge form loses its digits: it has the inverse of F in it.
    if (std::abs(gradient.determinant()) < 0.1) continue;
    ++(gradient.determinant() > 0 ? upright : inverted);

    const Incidence incidence = BuildIncidence(mesh);
    const Vector3d direction = Vector3d(random(), random(), random()).normalized();
    for (const bool with_fibres : {false, true}) {
      ElasticPart part{.law = GetParam(), .lame = {ToLame(kYoungs, 0.3)}};
      if (with_fibres)
        part.fibres = {{{{direction[0], direction[1], direction[2]}}, {2 * kYoungs}}};
      const auto term = MakeElasticTerm(Precision::kDouble, mesh, incidence, std::move(part),
                                        FractureStress::kTotal);
      NodalVector forces(4, Splat(0));
      std::vector<Matrix3d> stress(1, Matrix3d::Zero());
      term->ChooseBranches(displacements, BranchChoice::kStart);
      term->AddForces(displacements, forces);
      term->AddEffectiveStress(displacements, stress);
      Eigen::Matrix<double, 3, 4> shape;  // gradients of the shape functions
      shape.rightCols<3>() = rest.inverse().transpose();
      shape.col(0) = -shape.rightCols<3>().rowwise().sum();
      const Matrix3d second = gradient.inverse() * stress[0];
      double size = 0;
      for (const Double4& force : forces) size += std::sqrt(Dot(force, force));
      for (int i = 0; i < 4; ++i) {
        Vector3d by_edges = Vector3d::Zero();
        for (int j = 0; j < 4; ++j) {
          const double tension = -volume * shape.col(i).dot(second * shape.col(j));
          by_edges -= tension * (now[static_cast<size_t>(i)] - now[static_cast<size_t>(j)]);
        }
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(by_edges[axis], forces[static_cast<size_t>(i)][axis], 1e-11 * size)
              << "sample " << sample << ", fibres " << with_fibres;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllLaws, EdgeForm,
                         ::testing::Values(ElasticLaw::kStableNeoHookean,
                                           ElasticLaw::kInvertibleNeoHookean,
                                           ElasticLaw::kCorotatedLinear,
                                           ElasticLaw::kStVenantKirchhoff));

}  // namespace
}  // namespace cleave

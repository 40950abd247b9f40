// Equation 1 of the paper: nodal forces as tensions of edges. It must be the ordinary force of
// every law, with and without fibres, inverted or not (method note, section 1).

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/damage/fracture.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_geometry.h"
#include "core/model/elastic_term.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUnbreakable = std::numeric_limits<double>::infinity();

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

// Values of the method note: a stable Neo-Hookean tet with fibres (E = 1000 Pa, nu = 0.3, 2000 Pa
// along (0.6, 0.8, 0)), its stress (Pa), forces (N), tensions of edges (N/m) and stresses of edges
// (Pa) by its total stress and by that of the isotropic solid alone.
TEST(ReferenceTet, HasItsStressForcesTensionsAndEdgeStresses) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0.2, 1.1}};
  mesh.tets = {{0, 1, 2, 3}};
  const Incidence incidence = BuildIncidence(mesh);
  const std::vector<Vec3> positions = {
      {0.02, 0, 0.01}, {1.12, 0.17, -0.19}, {0.37, 0.86, 0.175}, {0.04, 0.515, 1.395}};
  constexpr double kStress[9] = {244.139802069357, 209.446017375931, -87.1034805881337,
                                 161.416552223593, 149.322679239687, 143.944906811375,
                                 -119.69978816201, 102.490810561027, 263.28686454934};
  constexpr double kForces[4][3] = {{53.6862923251534, 58.4203428988597, 24.22208632564},
                                    {-32.8645197312896, -19.6698412793303, 25.1327013270721},
                                    {-36.68081703294, -19.8582656874833, -12.647060675096},
                                    {15.8590444390762, -18.8922359320461, -36.707726977616}};
  constexpr double kTensions[6] = {31.9398476295064,  52.0987763833289, 15.8944099265646,
                                   -30.0058786900948, 18.7362003300034, -12.2974658145339};
  constexpr double kTotal[6] = {302.203906722967, 287.407625781695, 312.016928467544,
                                85.4783197318634, 350.744179945701, 202.825829524528};
  constexpr double kMatrix[6] = {196.101536212952, 129.19916099842,  304.040387577082,
                                 87.120819119545,  331.328635868884, 162.419017690909};

  NodalVector displacements(4, Splat(0));
  for (size_t node = 0; node < 4; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<size_t>(axis);
      displacements[node][axis] = positions[node][i] - mesh.rest_positions[node][i];
    }
  }
  EdgeFracture fracture(mesh, incidence, Broadcast<double>::Uniform(kUnbreakable), {});
  for (const FractureStress of : {FractureStress::kTotal, FractureStress::kMatrix}) {
    ElasticPart part{.lame = {ToLame(1000, 0.3)}};
    part.fibres = {{{{0.6, 0.8, 0}}, {2000}}};
    const auto term = MakeElasticTerm(Precision::kDouble, mesh, incidence, std::move(part), of);
    NodalVector forces(4, Splat(0));
    std::vector<Matrix3d> stress(1, Matrix3d::Zero());
    term->ChooseBranches(displacements, BranchChoice::kStart);
    term->AddForces(displacements, forces);
    term->AddEffectiveStress(displacements, stress);
    for (size_t i = 0; i < 4; ++i) {
      Vector3d by_edges = Vector3d::Zero();
      for (size_t edge = 0; edge < 6; ++edge) {
        const auto [a, b] = incidence.edges[edge];
        if (a != static_cast<int32_t>(i) && b != static_cast<int32_t>(i)) continue;
        const auto other = static_cast<size_t>(a) == i ? b : a;
        by_edges -= kTensions[edge] * (Vector3d(positions[i].data()) -
                                       Vector3d(positions[static_cast<size_t>(other)].data()));
      }
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(forces[i][axis], kForces[i][axis], 1e-11) << "node " << i;
        EXPECT_NEAR(by_edges[axis], kForces[i][axis], 1e-11) << "node " << i;
      }
    }
    if (of == FractureStress::kTotal) {
      for (int k = 0; k < 9; ++k) EXPECT_NEAR(stress[0](k / 3, k % 3), kStress[k], 1e-11);
    }
    std::vector<double> edge_stresses(6);
    fracture.EdgeStresses(positions, stress, nullptr, edge_stresses);
    for (size_t edge = 0; edge < 6; ++edge) {
      EXPECT_NEAR(edge_stresses[edge], (of == FractureStress::kTotal ? kTotal : kMatrix)[edge],
                  1e-11)
          << "edge " << edge;
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

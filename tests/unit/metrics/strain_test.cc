#include "tests/metrics/strain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

Frame AtRest(const TetMesh& mesh) {
  Frame frame;
  frame.positions = mesh.rest_positions;
  return frame;
}

TEST(Strain, IsTheLargestPrincipalStretchWhateverTheTurn) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 2, 3});
  Frame frame = AtRest(mesh);
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3& x : frame.positions) {
    // By 1.25 along y, 0.8 along z, then turned about z and moved.
    const Vec3 stretched = {x[0], 1.25 * x[1], 0.8 * x[2]};
    x = {c * stretched[0] - s * stretched[1] + 5, s * stretched[0] + c * stretched[1],
         stretched[2]};
  }
  for (int32_t tet = 0; tet < mesh.tet_count(); ++tet)
    EXPECT_NEAR(PrincipalStrain(mesh, tet, frame), 0.25, 1e-12);
  EXPECT_NEAR(PrincipalStrain(mesh, 0, AtRest(mesh)), 0, 1e-12);
}

TEST(Strain, TheDistanceIsFromTheWorstTetToTheNearestEdgeThatBrokeFirst) {
  const TetMesh mesh = KuhnBox({10, 1, 1}, {10, 1, 1});
  const Incidence incidence = BuildIncidence(mesh);
  std::vector<Frame> frames(3, AtRest(mesh));
  // The cell from x = 7 to 8 is stretched twice as much as any other, then edges break elsewhere.
  for (Vec3& x : frames[1].positions) x[0] += 0.1 * x[0] + 0.1 * std::clamp(x[0] - 7, 0.0, 1.0);
  const auto edges_near = [&](double place) {
    std::vector<int32_t> edges;
    for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
      const auto& [a, b] = incidence.edges[edge];
      const double middle = (mesh.rest_positions[static_cast<size_t>(a)][0] +
                             mesh.rest_positions[static_cast<size_t>(b)][0]) /
                            2;
      if (std::abs(middle - place) < 0.1) edges.push_back(static_cast<int32_t>(edge));
    }
    return edges;
  };
  frames[2].broken_edges = edges_near(3.5);
  const double far = StrainToFirstCrack(mesh, incidence, frames);
  EXPECT_GT(far, 3.5);
  EXPECT_LT(far, 4.5);
  frames[2].broken_edges = edges_near(7.5);
  EXPECT_LT(StrainToFirstCrack(mesh, incidence, frames), 0.5);
}

TEST(Strain, ThereIsNoDistanceWithoutAFirstCrackAfterARestState) {
  const TetMesh mesh = KuhnBox({2, 1, 1}, {2, 1, 1});
  const Incidence incidence = BuildIncidence(mesh);
  std::vector<Frame> frames(2, AtRest(mesh));
  EXPECT_EQ(StrainToFirstCrack(mesh, incidence, frames), -1);
  EXPECT_EQ(StrainToFirstCrack(mesh, incidence, {}), -1);
  frames[0].broken_edges = frames[1].broken_edges = {0};
  EXPECT_EQ(StrainToFirstCrack(mesh, incidence, frames), -1);
}

}  // namespace
}  // namespace cleave

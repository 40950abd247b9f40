// All 64 ways to break the edges of a single tet.

#include <gtest/gtest.h>

#include "core/mesh/tet_geometry.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

// Reference values of the method note, by mask. A cut quad has two sides of two triangles.
constexpr int kCutQuads[64] = {0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0,
                               0, 3, 0, 3, 0, 3, 0, 3, 4, 5, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 3, 3,
                               0, 4, 3, 5, 0, 0, 0, 4, 3, 3, 3, 5, 0, 3, 3, 5, 3, 5, 5, 6};
constexpr int kFragments[64] = {1, 1, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 1,
                                1, 2, 1, 2, 1, 2, 1, 2, 2, 3, 1, 1, 1, 1, 1, 1, 1, 2, 1, 1, 2, 2,
                                1, 2, 2, 3, 1, 1, 1, 2, 2, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

class OneTetSurface : public ::testing::Test {
 protected:
  static TetMesh Tet() {
    TetMesh mesh;
    mesh.rest_positions = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0.2, 1.1}};
    mesh.tets = {{0, 1, 2, 3}};
    return mesh;
  }
  std::vector<int32_t> EdgesOf(size_t mask) const {
    std::vector<int32_t> edges;
    for (size_t k = 0; k < 6; ++k) {
      if ((mask >> k & 1) != 0) edges.push_back(tet_.incidence.tet_edges[0][k]);
    }
    return edges;
  }

  const SurfaceCase tet_{Tet()};
  const double volume_ = SignedVolume(CornersOf(tet_.mesh, 0));
};

TEST_F(OneTetSurface, HasTheReferenceQuadsAndFragments) {
  for (size_t mask = 0; mask < 64; ++mask) {
    const BrokenSurface surface = tet_.Extract(EdgesOf(mask));
    EXPECT_EQ(surface.fragment_count, kFragments[mask]) << "mask " << mask;
    EXPECT_EQ(std::count(surface.inside.begin(), surface.inside.end(), 1), 4 * kCutQuads[mask])
        << "mask " << mask;
  }
}

TEST_F(OneTetSurface, IsClosedAroundEachFragment) {
  for (size_t mask = 0; mask < 64; ++mask) {
    SCOPED_TRACE(mask);
    ASSERT_NO_FATAL_FAILURE(ExpectClosedOrientedPieces(tet_.Extract(EdgesOf(mask), false)));
    ASSERT_NO_FATAL_FAILURE(ExpectClosedOrientedPieces(tet_.Extract(EdgesOf(mask), true)));
  }
}

TEST_F(OneTetSurface, GivesEachVertexAQuarterOfTheVolume) {
  for (size_t mask = 0; mask < 64; ++mask) {
    const BrokenSurface surface = tet_.Extract(EdgesOf(mask));
    std::vector<double> expected(static_cast<size_t>(surface.fragment_count), 0.0);
    for (const int32_t fragment : surface.node_fragments)
      expected[static_cast<size_t>(fragment)] += volume_ / 4;
    const std::vector<double> volumes = EnclosedVolumes(surface, RestPoints(surface));
    for (size_t i = 0; i < volumes.size(); ++i)
      EXPECT_NEAR(volumes[i], expected[i], 1e-15) << "mask " << mask;
  }
}

TEST_F(OneTetSurface, KeepsItsVolumeWhenSmooth) {
  for (size_t mask = 0; mask < 64; ++mask) {
    const BrokenSurface surface = tet_.Extract(EdgesOf(mask), true);
    double sum = 0;
    for (const double volume : EnclosedVolumes(surface, RestPoints(surface))) {
      EXPECT_GT(volume, 0) << "mask " << mask;
      sum += volume;
    }
    EXPECT_NEAR(sum, volume_, 1e-15) << "mask " << mask;
  }
}

TEST_F(OneTetSurface, SmoothCutsOfOneAndTwoVerticesAreFlat) {
  // Vertex 0 cut off: the crack is the triangle of the midpoints of its edges, seen twice.
  const BrokenSurface one = tet_.Extract(EdgesOf(0b000111), true);
  const std::vector<double> volumes = EnclosedVolumes(one, RestPoints(one));
  EXPECT_NEAR(volumes[0], volume_ / 8, 1e-15);
  // Vertices 0, 1 from 2, 3: the parallelogram of four midpoints halves the tet.
  const BrokenSurface two = tet_.Extract(EdgesOf(0b011110), true);
  EXPECT_NEAR(EnclosedVolumes(two, RestPoints(two))[0], volume_ / 2, 1e-15);
}

TEST_F(OneTetSurface, UnbrokenIsFourTriangles) {
  const BrokenSurface surface = tet_.Extract({});
  EXPECT_EQ(surface.triangles.size(), 4u);
  EXPECT_EQ(surface.points.size(), 4u);
}

}  // namespace
}  // namespace cleave

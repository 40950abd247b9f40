#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_geometry.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/surface/faces.h"
#include "core/surface/point_motion.h"
#include "core/surface/visible_surface.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"
#include "tests/unit/core/stream/surface_view_scene.h"

namespace cleave {
namespace {

using namespace stream_test;

// All that is drawn follows from visible nodes: with others anywhere it is the same to the bit.
TEST(SurfaceView, TheSurfaceThatIsDrawnIsThatOfAllNodes) {
  const Body body = LatticeBody(12, 6, 6);
  TetMesh mesh;
  mesh.rest_positions = body.rest;
  mesh.tets = body.tets;
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const TetCorners corners = CornersOf(mesh, static_cast<int64_t>(tet));
    if (SignedVolume(corners) < 0) std::swap(mesh.tets[tet][2], mesh.tets[tet][3]);
  }
  const Incidence incidence = BuildIncidence(mesh);
  ASSERT_EQ(incidence.edges, body.edges);
  const Faces faces = BuildFaces(mesh);
  VisibleSurface surface(mesh, incidence, faces, {});
  PointMotion of_all(mesh, incidence);
  PointMotion of_visible(mesh, incidence);
  FrameEncoder encoder = MakeEncoder(OfSurface(body), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  std::vector<int32_t> broken;
  size_t off_nodes = 0;
  size_t hidden = 0;
  for (int64_t number = 0; number < 20; ++number) {
    const Frame frame = TumblingFrame(body, number);
    ASSERT_TRUE(decoder.Apply(encoder.Encode(frame)->bytes).ok());
    std::vector<int32_t> fresh;
    std::set_difference(frame.broken_edges.begin(), frame.broken_edges.end(), broken.begin(),
                        broken.end(), std::back_inserter(fresh));
    broken = frame.broken_edges;
    surface.Break(fresh);
    const Frame& seen = decoder.frame();
    std::vector<Vec3> all = seen.positions;
    for (size_t node = 0; node < all.size(); ++node) {
      if (seen.visible[node] == 0) all[node] = frame.positions[node];
      hidden += seen.visible[node] == 0 ? 1 : 0;
    }
    std::vector<Vec3> points;
    std::vector<Vec3> expected;
    of_visible.Move(surface.topology(), seen.positions, points);
    of_all.Move(surface.topology(), all, expected);
    ASSERT_EQ(points, expected) << number;
    for (const SurfacePoint& point : surface.topology().points) {
      off_nodes += point.owned_by_all() ? 0 : 1;
    }
  }
  EXPECT_GT(off_nodes, 1000u);
  EXPECT_GT(hidden, 500u);
}

}  // namespace
}  // namespace cleave

// What following a crack costs by the frame, against taking the surface of the whole body.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/damage/components.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/procedural.h"
#include "core/surface/visible_surface.h"
#include "tests/bench/core/step_cost.h"

namespace cleave {
namespace {

constexpr int kFrames = 40;

absl::Status Measure(double cell_size) {
  BoxMesh box;
  box.size = {0.3, 0.1, 0.1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = cell_size;
  CLEAVE_ASSIGN_OR_RETURN(const TetMesh mesh, BuildMesh(box));
  const Incidence incidence = BuildIncidence(mesh);
  const Faces faces = BuildFaces(mesh);
  // A cut through the middle of the bar runs down from its top.
  Vec3 from = mesh.rest_positions[0], to = from;
  for (const Vec3& at : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      from[axis] = std::min(from[axis], at[axis]);
      to[axis] = std::max(to[axis], at[axis]);
    }
  }
  const double low = from[2], high = to[2];
  const double middle = 0.5 * (from[0] + to[0]);
  std::vector<std::vector<int32_t>> frames(kFrames);
  for (int32_t edge = 0; edge < static_cast<int32_t>(incidence.edge_count()); ++edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const Vec3& p = mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = mesh.rest_positions[static_cast<size_t>(b)];
    if ((p[0] < middle) == (q[0] < middle)) continue;
    const double depth = (high - 0.5 * (p[2] + q[2])) / (high - low);
    const auto frame = static_cast<size_t>(std::clamp(depth * kFrames, 0.0, kFrames - 1.0));
    frames[frame].push_back(edge);
  }
  VisibleSurface surface(mesh, incidence, faces, {});
  NamedPieces pieces(mesh, incidence);
  std::vector<uint8_t> flags(incidence.edges.size(), 0);
  std::vector<int32_t> broken, labels;
  double grown = 0, taken = 0, followed = 0, labelled = 0;
  int64_t made = 0;
  for (const std::vector<int32_t>& edges : frames) {
    for (const int32_t edge : edges) flags[static_cast<size_t>(edge)] = 1;
    broken.insert(broken.end(), edges.begin(), edges.end());
    std::sort(broken.begin(), broken.end());
    {
      ScopedTimer timer(grown);
      made += surface.Break(edges);
    }
    {
      ScopedTimer timer(taken);
      const SurfaceTopology whole = ExtractSurface(mesh, incidence, faces, broken, {});
      if (whole.triangles.size() != surface.topology().triangles.size())
        return absl::InternalError("the grown surface is another one");
    }
    {
      ScopedTimer timer(followed);
      pieces.Break(edges);
    }
    ScopedTimer timer(labelled);
    if (LabelComponents(incidence, flags, labels) != pieces.count())
      return absl::InternalError("the pieces are others");
  }
  std::printf("%9lld %8zu %9zu %9.1f %10.3f %10.3f %7.0f %10.3f %10.3f %7.0f\n",
              static_cast<long long>(mesh.tet_count()), broken.size(),
              surface.topology().triangles.size(), static_cast<double>(made) / kFrames,
              1e3 * grown / kFrames, 1e3 * taken / kFrames, taken / grown, 1e3 * followed / kFrames,
              1e3 * labelled / kFrames, labelled / followed);
  std::fflush(stdout);
  return absl::OkStatus();
}

}  // namespace

absl::Status PrintSurface() {
  std::printf("\nA bar cut through in %d frames: surface and pieces, from what broke and anew.\n\n",
              kFrames);
  std::printf("%9s %8s %9s %9s %21s %7s %21s %7s\n", "", "", "", "made a", "surface, ms a frame",
              "", "pieces, ms a frame", "");
  std::printf("%9s %8s %9s %9s %10s %10s %7s %10s %10s %7s\n", "tets", "broken", "triangles",
              "frame", "followed", "anew", "ratio", "followed", "anew", "ratio");
  for (const double cell : {0.01, 0.005, 0.0025}) CLEAVE_RETURN_IF_ERROR(Measure(cell));
  return absl::OkStatus();
}

}  // namespace cleave

#ifndef CLEAVE_CORE_STREAM_STREAM_MESH_H_
#define CLEAVE_CORE_STREAM_STREAM_MESH_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// What a stream needs of its mesh. It is a view: what it is made from outlives it.
struct StreamMesh {
  StreamMesh(std::span<const Vec3> rest, std::span<const std::array<int32_t, 2>> mesh_edges = {},
             std::span<const std::array<int32_t, 4>> mesh_tets = {})
      : rest_positions(rest), edges(mesh_edges), tets(mesh_tets) {}
  StreamMesh(const std::vector<Vec3>& rest, std::span<const std::array<int32_t, 2>> mesh_edges = {},
             std::span<const std::array<int32_t, 4>> mesh_tets = {})
      : rest_positions(rest), edges(mesh_edges), tets(mesh_tets) {}

  std::span<const Vec3> rest_positions;           // m, to the bit those of the stream
  std::span<const std::array<int32_t, 2>> edges;  // Incidence::edges; unused by predictor 1
  std::span<const std::array<int32_t, 4>> tets;   // by node; only used by the surface view
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STREAM_MESH_H_

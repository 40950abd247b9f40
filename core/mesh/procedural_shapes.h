#ifndef CLEAVE_CORE_MESH_PROCEDURAL_SHAPES_H_
#define CLEAVE_CORE_MESH_PROCEDURAL_SHAPES_H_

#include <cstdint>

#include "core/base/vec3.h"

// The bodies that Cleave can mesh by itself, as plain data; messages of the same names are in
// proto/cleave/v1/scene.proto.

namespace cleave {

// How a procedural mesh places its nodes.
enum class MeshLayout {
  kJitteredLattice,  // a grid of cells, six tets each, inner nodes moved by a random offset
  kUnstructured,     // Delaunay tets of well-spaced random points: no preferred direction
};

// What all procedural meshes share.
struct MeshResolution {
  MeshLayout layout = MeshLayout::kUnstructured;
  double cell_size = 0;  // m, wanted edge length
  double jitter = 0.2;   // lattice only: largest offset of a node, in cells
  uint32_t seed = 1;
};

// An axis-aligned box; centre at the origin unless `origin` moves its smallest corner.
struct BoxMesh {
  Vec3 origin{0, 0, 0};  // m, smallest corner
  Vec3 size{0, 0, 0};    // m
  MeshResolution resolution;
};

// A solid cylinder along z, its base centred on `origin`.
struct CylinderMesh {
  Vec3 origin{0, 0, 0};  // m
  double radius = 0;     // m
  double height = 0;     // m
  MeshResolution resolution;
};

// A hollow cylinder along z, its base centred on `origin`.
struct TubeMesh {
  Vec3 origin{0, 0, 0};     // m
  double outer_radius = 0;  // m
  double inner_radius = 0;  // m
  double height = 0;        // m
  MeshResolution resolution;
};

// A flat cylinder: the same shape as CylinderMesh, meshed with at least two cells through its
// thickness however thin it is.
struct DiscMesh {
  Vec3 origin{0, 0, 0};  // m
  double radius = 0;     // m
  double thickness = 0;  // m
  MeshResolution resolution;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_PROCEDURAL_SHAPES_H_

#ifndef CLEAVE_CORE_MODEL_FOOTPRINT_H_
#define CLEAVE_CORE_MODEL_FOOTPRINT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace cleave {

// A part of the model that a scene asks for, and the memory that it takes while simulating.
struct Part {
  std::string name;
  int64_t bytes = 0;
};

struct Footprint {
  std::vector<Part> parts;       // in the order in which BuildModel makes them
  int64_t total_bytes = 0;       // of the simulation; what surrounds it comes on top
  double seconds_per_frame = 0;  // an estimate, on one thread
  double total_seconds = 0;      // of all frames
};

// What simulating `scene` on a mesh of these counts will take, before anything is allocated. Bytes
// are those of the arrays, as allocated; of node sets, whose size only the mesh tells, the largest
// that they can be. Seconds come from costs measured on a 2.6 GHz server core and a guess of how
// many solver iterations steps take; a hard scene can take several times as long. Preconditions:
// ValidateScene holds, counts are not negative.
Footprint PlanModel(const Scene& scene, int64_t node_count, int64_t tet_count, int64_t edge_count);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_FOOTPRINT_H_

#ifndef CLEAVE_CLIENT_IO_IMPURITY_TRIM_PAINT_H_
#define CLEAVE_CLIENT_IO_IMPURITY_TRIM_PAINT_H_

#include <cstddef>

#include "cleave/v1/scene.pb.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// A scene travels in one message, of which servers take 4 MiB; the rest of a request is small.
inline constexpr size_t kMostSceneBytes = (4 << 20) - (64 << 10);

// Leaves out of the painted triangle surfaces of `message` what no node of the mesh (m) is closest
// to, and corners that no triangle has then: every node keeps its share, and a scanned surface of a
// million triangles becomes no larger than the mesh. `scene` is the same scene. Precondition:
// ValidateScene finds no error.
void TrimPaint(const Scene& scene, const TetMesh& mesh, v1::Scene& message);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_IMPURITY_TRIM_PAINT_H_

#ifndef CLEAVE_CLIENT_IO_PREVIEW_SCENE_LOOK_H_
#define CLEAVE_CLIENT_IO_PREVIEW_SCENE_LOOK_H_

#include "client/io/preview/preview.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// Makes pictures speak the scene's language: its name as title, a colour a material with its name
// in the legend, up against gravity, and its colliders where the scene puts them, but for planes.
// Overwrites those options and no others. `mesh` is the scene's.
void ApplySceneLook(const Scene& scene, const TetMesh& mesh, PreviewOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_SCENE_LOOK_H_

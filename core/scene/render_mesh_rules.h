#ifndef CLEAVE_CORE_SCENE_RENDER_MESH_RULES_H_
#define CLEAVE_CORE_SCENE_RENDER_MESH_RULES_H_

#include <span>

#include "core/base/faults.h"
#include "core/base/vec3.h"
#include "core/mesh/render_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// The rules of a scene's render mesh that hold without the mesh itself; fields as in the scene.
void CheckRenderMeshSource(const RenderMeshSource& source, Faults& faults);

// Whether ids are in range, numbers finite and arrays fit. Names the first bad item of each array.
Faults CheckRenderMesh(const RenderMesh& mesh);

// Whether a mesh is of the size of the body, where it is, and goes round it closely: one in other
// units would be divided into triangles without number, and what is far off follows a tet that it
// has nothing to do with. Refused where the diagonal of one bounding box is more than 1.5 times the
// other's, where the boxes do not meet, and where a point is farther from the body's box than half
// of its diagonal. Preconditions: CheckRenderMesh holds, there are rest positions (m).
Faults CheckRenderMeshFits(const RenderMesh& mesh, std::span<const Vec3> rest_positions);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_RENDER_MESH_RULES_H_

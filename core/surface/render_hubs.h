#ifndef CLEAVE_CORE_SURFACE_RENDER_HUBS_H_
#define CLEAVE_CORE_SURFACE_RENDER_HUBS_H_

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/divided_mesh.h"
#include "core/surface/faces.h"

namespace cleave {

// Where cracks that come from inside a body meet the render mesh round it: in one point for each
// pair and each triple of nodes, in the middle of where the render mesh lies between them.
class RenderHubs {
 public:
  struct Hub {
    Vec3 sum{0, 0, 0};  // m, at rest
    int32_t count = 0;
    Vec3 place() const { return {sum[0] / count, sum[1] / count, sum[2] / count}; }
  };
  // Three nodes at which the render mesh does not go round the tets as their faces do.
  struct Gap {
    DividedMesh::Triple
        nodes{};        // as the render mesh turns there, or should were it closed by this
    int32_t turns = 0;  // how often, > 0
    int64_t face = -1;  // 4 * tet + face of the lower tet, -1: the nodes have none
    int32_t group = 0;  // gaps that share two nodes are of one
  };

  // Takes from its arguments what it needs.
  RenderHubs(const TetMesh& mesh, const Faces& faces, const DividedMesh& divided);

  // Of these nodes, in any order; null where the render mesh does not lie between them.
  const Hub* Find(int32_t a, int32_t b) const;
  const Hub* Find(DividedMesh::Triple nodes) const;
  // The place of a hub among its kind. Precondition: there is one.
  int64_t IndexOf(int32_t a, int32_t b) const;
  int64_t IndexOf(DividedMesh::Triple nodes) const;

  // How often the render mesh goes round a tet: 1 or 0, but for odd meshes.
  int32_t inside(size_t tet) const { return inside_[tet]; }
  // By groups. With the faces of the tets that it goes round, what the render mesh crosses is the
  // boundary of nothing but them: of a closed render mesh, each group's gaps are closed themselves.
  const std::vector<Gap>& gaps() const { return gaps_; }

 private:
  using Crossings = std::map<int64_t, int32_t>;  // outward of the lower tet, by face

  void FindHubs(const DividedMesh& divided);
  void FindInside(const Faces& faces, const Crossings& crossings);
  void FindGaps(const TetMesh& mesh, const Faces& faces, const DividedMesh& divided);
  void GroupGaps();

  std::map<DividedMesh::Pair, Hub> pairs_;
  std::map<DividedMesh::Triple, Hub> triples_;
  std::vector<int32_t> inside_;
  std::vector<Gap> gaps_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_RENDER_HUBS_H_

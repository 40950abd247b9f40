#ifndef CLEAVE_CORE_SURFACE_TET_LOCATOR_H_
#define CLEAVE_CORE_SURFACE_TET_LOCATOR_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"

namespace cleave {

// A point by the tet that it goes with.
struct PlaceInTet {
  int32_t tet = 0;
  std::array<double, 4> weights{};  // barycentric: sum to 1, some below 0 outside of the tet
};

// Binds points to tets at rest, by a rule that does not hang on round-off, so that others who
// follow it (client/python/cleave/embedded.py) find the same: a point goes with the lowest tet in
// which none of its weights is below -kWeightSlack; where there is none, with the lowest of those
// tets that have a boundary face at most kDistanceSlack of the body's diagonal farther off than the
// nearest one. Thread-safe.
class TetLocator {
 public:
  // `mesh` and `faces`, which is the mesh's, must outlive this object; the mesh has a tet.
  TetLocator(const TetMesh& mesh, const Faces& faces);

  PlaceInTet Locate(const Vec3& point) const;

  // What counts as the same.
  static constexpr double kWeightSlack = 1e-9;
  static constexpr double kDistanceSlack = 1e-9;

 private:
  std::array<int32_t, 3> CellOf(const Vec3& point) const;
  int64_t IndexOf(const std::array<int32_t, 3>& cell) const {
    return (static_cast<int64_t>(cell[2]) * counts_[1] + cell[1]) * counts_[0] + cell[0];
  }
  // Calls back with every cell that the box of some points, a little enlarged, touches.
  template <typename Visit>
  void ForCellsOf(const int32_t* nodes, size_t count, const Visit& visit) const;
  template <typename Nodes>
  Csr Fill(int64_t items, const Nodes& nodes_of) const;
  std::array<double, 4> Weights(int32_t tet, const Vec3& point) const;

  const TetMesh& mesh_;
  const Faces& faces_;
  Vec3 origin_{};
  double cell_size_ = 1;  // m
  double diagonal_ = 0;   // m
  std::array<int32_t, 3> counts_{1, 1, 1};
  Csr cell_tets_;
  Csr cell_faces_;  // places in Faces::boundary
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_TET_LOCATOR_H_

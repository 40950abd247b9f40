#ifndef CLEAVE_CORE_MODEL_FIBRE_TERM_H_
#define CLEAVE_CORE_MODEL_FIBRE_TERM_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/tet_term.h"
#include "core/scene/scene.h"

namespace cleave {

// One family of fibres in some tets.
struct FibreFamilyPart {
  std::vector<int32_t> tets;      // ascending
  std::vector<Vec3> directions;   // unit, a tet each
  std::vector<double> stiffness;  // Pa, a tet each
};

// The energy of a family of fibres. Its stress breaks edges only where `stress` is kTotal. `mesh`
// must outlive the term.
std::unique_ptr<TetTerm> MakeFibreTerm(const TetMesh& mesh, const Incidence& incidence,
                                       const FibreFamilyPart& family, FractureStress stress);

// Bytes of a family's term over this many tets of a mesh.
int64_t FibreTermBytes(int64_t tet_count);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_FIBRE_TERM_H_

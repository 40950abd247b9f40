#ifndef CLEAVE_CORE_MODEL_ELASTIC_TERM_H_
#define CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/vec3.h"
#include "core/material/moduli.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/tet_term.h"
#include "core/scene/scene.h"

namespace cleave {

// A family of fibres in every tet of an elastic part.
struct FibreFamilyPart {
  std::vector<Vec3> directions;   // unit, a tet each
  std::vector<double> stiffness;  // Pa, a tet each
};

// Tets that one pass works on: all follow the same law and have as many families of fibres.
struct ElasticPart {
  ElasticLaw law = ElasticLaw::kStableNeoHookean;
  std::vector<int32_t> tets = {};           // ascending; empty for all of the mesh
  std::vector<LameConstants<double>> lame;  // a record for all tets, or one each
  std::vector<FibreFamilyPart> fibres = {};
  // Of ductile tets, a record for all or one each; else empty.
  std::vector<Plasticity> plasticity = {};
};

// The elastic energy of a part, fibres included, with element arithmetic in `precision`. The stress
// of fibres breaks edges only where `stress` is kTotal. `mesh` must outlive the term.
std::unique_ptr<TetTerm> MakeElasticTerm(Precision precision, const TetMesh& mesh,
                                         const Incidence& incidence, ElasticPart part,
                                         FractureStress stress);

// Bytes of terms over this many tets: without fibres, and what each family adds.
int64_t ElasticTermBytes(Precision precision, int64_t tet_count, bool uniform);
int64_t FibreFamilyBytes(Precision precision, int64_t tet_count);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

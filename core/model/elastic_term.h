#ifndef CLEAVE_CORE_MODEL_ELASTIC_TERM_H_
#define CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/material/moduli.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/tet_term.h"
#include "core/scene/scene.h"

namespace cleave {

// The elastic energy by `law` of the named tets of `mesh`, ascending, or of all where none is
// named. `lame` has a record for all of them or a record for each. `mesh` must outlive the term.
std::unique_ptr<TetTerm> MakeElasticTerm(ElasticLaw law, const TetMesh& mesh,
                                         const Incidence& incidence, std::vector<int32_t> tets,
                                         std::vector<LameConstants<double>> lame);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

#ifndef CLEAVE_CORE_MODEL_ELASTIC_TERM_H_
#define CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

#include <memory>
#include <vector>

#include "core/material/moduli.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/tet_term.h"

namespace cleave {

// The stable Neo-Hookean energy of every tet of `mesh`, which must outlive the term. `lame` has a
// record for all tets or a record a tet.
std::unique_ptr<TetTerm> MakeStableNeoHookeanTerm(const TetMesh& mesh, const Incidence& incidence,
                                                  std::vector<LameConstants<double>> lame);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_ELASTIC_TERM_H_

#include "core/model/elastic_passes.h"

namespace cleave {

template std::unique_ptr<TetTerm> MakeTermOf<Float8>(const TetMesh&, const Incidence&, ElasticPart,
                                                     FractureStress);

}  // namespace cleave

#include "core/model/plastic_passes.h"

namespace cleave {

template std::unique_ptr<PlasticTerm> MakePlasticTermOf<Float8>(const TetMesh&, const Incidence&,
                                                                ElasticPart, FractureStress);

}  // namespace cleave

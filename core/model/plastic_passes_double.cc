#include "core/model/plastic_passes.h"

namespace cleave {

template std::unique_ptr<PlasticTerm> MakePlasticTermOf<Double4>(const TetMesh&, const Incidence&,
                                                                 ElasticPart, FractureStress);

}  // namespace cleave

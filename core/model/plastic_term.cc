#include "core/model/plastic_term.h"

#include <utility>

#include "core/model/plastic_passes.h"

namespace cleave {
namespace {

template <typename T>
int64_t BytesOf(int64_t tet_count, bool uniform) {
  constexpr int64_t kCount = Lanes<T>::kCount;
  const int64_t batches = (tet_count + kCount - 1) / kCount;
  return batches * static_cast<int64_t>(2 * sizeof(PlasticState<T>) + sizeof(uint8_t)) +
         (uniform ? 1 : batches * PlasticShape<T>::kParts) *
             static_cast<int64_t>(sizeof(PlasticRecord));
}

}  // namespace

std::unique_ptr<PlasticTerm> MakePlasticTerm(Precision precision, const TetMesh& mesh,
                                             const Incidence& incidence, ElasticPart part,
                                             FractureStress stress) {
  return precision == Precision::kFloat
             ? MakePlasticTermOf<Float8>(mesh, incidence, std::move(part), stress)
             : MakePlasticTermOf<Double4>(mesh, incidence, std::move(part), stress);
}

int64_t PlasticBytes(Precision precision, int64_t tet_count, bool uniform) {
  return precision == Precision::kFloat ? BytesOf<Float8>(tet_count, uniform)
                                        : BytesOf<Double4>(tet_count, uniform);
}

}  // namespace cleave

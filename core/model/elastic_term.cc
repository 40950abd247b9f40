#include "core/model/elastic_term.h"

#include <utility>

#include "core/model/elastic_passes.h"

namespace cleave {
namespace {

template <typename T>
int64_t Batches(int64_t tet_count) {
  return (tet_count + TetBatches<T>::kLanes - 1) / TetBatches<T>::kLanes;
}

template <typename T>
int64_t ElasticBytes(int64_t tet_count, bool uniform) {
  const int64_t batches = Batches<T>(tet_count);
  return batches * static_cast<int64_t>(sizeof(TetBatch<T>)) +
         (uniform ? 1 : batches) * static_cast<int64_t>(sizeof(LameConstants<T>));
}

template <typename T>
int64_t FibreBytes(int64_t tet_count) {
  return Batches<T>(tet_count) * static_cast<int64_t>(sizeof(FibreBatch<T>));
}

}  // namespace

std::unique_ptr<TetTerm> MakeElasticTerm(Precision precision, const TetMesh& mesh,
                                         const Incidence& incidence, ElasticPart part,
                                         FractureStress stress) {
  return precision == Precision::kFloat
             ? MakeTermOf<Float8>(mesh, incidence, std::move(part), stress)
             : MakeTermOf<Double4>(mesh, incidence, std::move(part), stress);
}

int64_t ElasticTermBytes(Precision precision, int64_t tet_count, bool uniform) {
  return precision == Precision::kFloat ? ElasticBytes<Float8>(tet_count, uniform)
                                        : ElasticBytes<Double4>(tet_count, uniform);
}

int64_t FibreFamilyBytes(Precision precision, int64_t tet_count) {
  return precision == Precision::kFloat ? FibreBytes<Float8>(tet_count)
                                        : FibreBytes<Double4>(tet_count);
}

}  // namespace cleave

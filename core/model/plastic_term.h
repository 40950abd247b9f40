#ifndef CLEAVE_CORE_MODEL_PLASTIC_TERM_H_
#define CLEAVE_CORE_MODEL_PLASTIC_TERM_H_

#include <cstdint>
#include <memory>
#include <span>

#include "core/damage/plastic_tet.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/elastic_term.h"
#include "core/model/nodal_vector.h"
#include "core/model/tet_term.h"
#include "core/scene/scene.h"

namespace cleave {

// The energy of ductile tets. Within a step they are elastic, about the plastic strain that they
// had at its start. AddEffectiveStress gives the stress dPsi/dF_e that is left after the last Flow,
// so that what a step overshoots the yield surface by breaks nothing.
class PlasticTerm : public TetTerm {
 public:
  // Finds where a step of `dt` (s) that ends at these displacements leaves the plastic strain, from
  // that at its start; replaces what the last call found.
  virtual void Flow(const NodalVector& displacements, double dt) = 0;
  // Keeps what the last Flow found: the next step starts there. Returns the elastic energy that
  // flow took out, J, >= 0.
  virtual double KeepFlow() = 0;

  // The tets of this term, by their place in it.
  virtual int64_t tet_count() const = 0;
  virtual int64_t tet_at(int64_t place) const = 0;
  // Of all its tets, by place, after the last Flow. Precondition: room for tet_count().
  virtual void GetPlasticTets(std::span<PlasticTet> tets) const = 0;
  // The equivalent plastic strains that were kept, by place.
  virtual void GetPlasticStrains(std::span<double> strains) const = 0;
};

// Of a part with plasticity. As MakeElasticTerm.
std::unique_ptr<PlasticTerm> MakePlasticTerm(Precision precision, const TetMesh& mesh,
                                             const Incidence& incidence, ElasticPart part,
                                             FractureStress stress);

// Bytes that plasticity adds to an elastic term over this many tets.
int64_t PlasticBytes(Precision precision, int64_t tet_count, bool uniform);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_PLASTIC_TERM_H_

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

// What the flow of a step took, J.
struct FlowWork {
  double work = 0;  // out of the body
  double potential =
      0;  // what the term's energy at the end of the step holds beyond elastic energy
};

// The energy of ductile tets: within a step the incremental potential of
// core/material/incremental_potential.h, elastic energy and what flow since its start takes, so
// that a solve ends in equilibrium with the stress after the flow. Fibres hold the solid to the
// shape that it had at the start of the step. AddEffectiveStress gives the stress dPsi/dF_e after
// the last Flow.
class PlasticTerm : public TetTerm {
 public:
  // To be called before the solve of a step of `dt` (s), which flows from what was kept last.
  virtual void BeginStep(double dt) = 0;
  // Finds where a step that ends at these displacements leaves the plastic strain; replaces what
  // the last call found.
  virtual void Flow(const NodalVector& displacements) = 0;
  // Keeps what the last Flow found: the next step starts there.
  virtual FlowWork KeepFlow() = 0;

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

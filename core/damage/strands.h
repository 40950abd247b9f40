#ifndef CLEAVE_CORE_DAMAGE_STRANDS_H_
#define CLEAVE_CORE_DAMAGE_STRANDS_H_

#include <cstddef>
#include <cstdint>
#include <span>

namespace cleave {

// How tets of a material hold on after the rules of fracture have taken them out of the solid.
struct StrandLaw {
  double residual_factor = 0;  // what their damage factor is then at most, [kDeadFactor, 1)
  double stretch_limit = 0;    // length over rest length of an unbroken edge at which they die, > 1
};

// Laws of a mesh's tets. Views: what they refer to must outlive this.
struct StrandLaws {
  std::span<const StrandLaw> laws;    // empty: no tet has any
  std::span<const int16_t> tet_laws;  // of a tet each, -1 for none; empty: the first for all

  bool empty() const { return laws.empty(); }
  // Null where the tet has none.
  const StrandLaw* Of(int32_t tet) const {
    if (laws.empty()) return nullptr;
    if (tet_laws.empty()) return laws.data();
    const int16_t law = tet_laws[static_cast<size_t>(tet)];
    return law < 0 ? nullptr : &laws[static_cast<size_t>(law)];
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_STRANDS_H_

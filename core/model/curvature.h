#ifndef CLEAVE_CORE_MODEL_CURVATURE_H_
#define CLEAVE_CORE_MODEL_CURVATURE_H_

namespace cleave {

// Which second derivative of an energy.
enum class Curvature {
  kSemidefinite,  // a stand-in without negative eigenvalues: always leads downhill
  kExact,         // may be indefinite, but converges quadratically
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_CURVATURE_H_

#ifndef CLEAVE_CORE_MATERIAL_MODULI_H_
#define CLEAVE_CORE_MATERIAL_MODULI_H_

namespace cleave {

// The Lame constants of an isotropic material, Pa; T is a number or a batch of them.
template <typename T>
struct LameConstants {
  T mu;
  T lambda;
};

// From Young's modulus (Pa, > 0) and Poisson's ratio (in [0, 0.5)).
inline LameConstants<double> ToLame(double youngs_modulus, double poisson_ratio) {
  return {youngs_modulus / (2 * (1 + poisson_ratio)),
          youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))};
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_MODULI_H_

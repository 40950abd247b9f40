#ifndef CLEAVE_TESTS_SCENES_CRITERIA_H_
#define CLEAVE_TESTS_SCENES_CRITERIA_H_

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/procedural_shapes.h"

// What decides whether a demonstration shows what it should, as data: tests, the scene runner and
// the gallery all go by these.

namespace cleave {

// Which of a demonstration's bodies.
struct Setting {
  std::string variant = {};  // "iso", "fibre30" ...; each lists its own
  uint32_t seed = 1;         // of mesh and impurities
  MeshLayout layout = MeshLayout::kUnstructured;
  double coarseness = 1;  // cells this many times as long as at full size
};

// Named numbers, as the scene runner prints them.
using Metrics = std::map<std::string, double>;

// What the variants of one seed, layout and coarseness measured.
struct Trial {
  Setting setting;  // its variant means nothing
  std::map<std::string, Metrics> variants;

  // Not a number where it was not measured; that meets no limit.
  double Get(const std::string& variant, const std::string& metric) const;
};

enum class Relation { kAtMost, kAtLeast, kBelow, kAbove };

// A measured value and its bound.
struct Condition {
  std::string text;  // what is measured, with its unit
  std::function<double(const Trial&)> value;
  Relation relation = Relation::kAtMost;
  double limit = 0;

  bool Met(double measured) const;
  std::string Bound() const;  // "at least 3"
};

// How many of the trials decide. With one-sided limits the median meets what most trials meet.
inline constexpr double kHalf = 0.5;  // the median
inline constexpr double kMost = 0.8;  // 4 of 5 seeds
inline constexpr double kAll = 1;

struct Criterion {
  std::string text;                   // the fact
  std::vector<std::string> variants;  // that it is about
  std::vector<Condition> conditions;  // a trial meets the criterion where it meets all of them
  // Of runs that lack what makes the fact true: they must not meet it, or it is not evidence.
  bool control = false;
  double share = kMost;    // of the trials that must meet it, or of a control, must not
  bool full_size = false;  // coarse bodies cannot show it
};

// Whether a criterion holds over some trials.
struct Finding {
  std::vector<std::vector<double>> values;  // a condition each, a trial each
  int met = 0;                              // trials that meet all conditions
  int unmeasured = 0;                       // trials that lack a value
  bool holds = false;                       // of a control: is not met, and was measured
};
// Of so many trials, how many must meet it, or of a control, must not.
int TrialsNeeded(const Criterion& criterion, int trials);
Finding Judge(const Criterion& criterion, std::span<const Trial> trials);

// Variants that any of the criteria is about, each once, in the order of first use.
std::vector<std::string> VariantsOf(std::span<const Criterion> criteria);

// Values of conditions: a metric of a variant; the quotient and the difference of two.
using Value = std::function<double(const Trial&)>;
Value Of(std::string variant, std::string metric);
Value Ratio(Value upper, Value lower);
Value Difference(Value from, Value what);

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_CRITERIA_H_

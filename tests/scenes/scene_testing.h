#ifndef CLEAVE_TESTS_SCENES_SCENE_TESTING_H_
#define CLEAVE_TESTS_SCENES_SCENE_TESTING_H_

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "tests/scenes/demonstration.h"

// Tests of demonstrations: short ones, of one coarse body, belong to every test run; those whose
// suite begins with "Full" have full-sized bodies of several seeds and both layouts, and the label
// "scenes". Parameters were tuned on seed 1; full ones report the others.

namespace cleave {

inline constexpr std::array<uint32_t, 5> kReportedSeeds = {2, 3, 4, 5, 6};
inline constexpr std::array<MeshLayout, 2> kLayouts = {MeshLayout::kJitteredLattice,
                                                       MeshLayout::kUnstructured};

// Prints what a full run found, whether or not it meets its criterion.
inline void Report(const std::string& name, const Setting& setting, const Metrics& found) {
  std::printf("%s seed %u %s:", name.c_str(), setting.seed,
              setting.layout == MeshLayout::kJitteredLattice ? "lattice" : "unstructured");
  for (const auto& [key, value] : found) std::printf(" %s=%.4g", key.c_str(), value);
  std::printf("\n");
  std::fflush(stdout);
}

// Runs and measures variants; one that fails to run is a failure of the test and has no metrics.
inline Trial MustTry(const std::string& name, Setting setting,
                     const std::vector<std::string>& variants) {
  Trial trial{setting, {}};
  for (const std::string& variant : variants) {
    setting.variant = variant;
    const auto outcome = Demonstrate(name, setting);
    EXPECT_TRUE(outcome.ok()) << name << " " << variant << ": " << outcome.status();
    if (outcome.ok()) trial.variants[variant] = outcome->metrics;
  }
  return trial;
}

inline void ExpectHolds(const Criterion& criterion, std::span<const Trial> trials) {
  const Finding finding = Judge(criterion, trials);
  std::string measured;
  for (size_t i = 0; i < finding.values.size(); ++i) {
    const Condition& condition = criterion.conditions[i];
    absl::StrAppend(&measured, "\n  ", condition.text, ": ", absl::StrJoin(finding.values[i], ", "),
                    "; ", condition.Bound());
  }
  EXPECT_TRUE(finding.holds) << criterion.text << (criterion.control ? " (a control)" : "") << ": "
                             << finding.met << " of " << trials.size() << " meet" << measured;
}

// Of one body of each variant, as coarse as they can be; full-size criteria are left out.
inline void ExpectCriteria(const std::string& name, MeshLayout layout = MeshLayout::kUnstructured) {
  const auto kind = FindDemonstration(name);
  ASSERT_TRUE(kind.ok()) << kind.status();
  const Setting setting{.seed = 1, .layout = layout, .coarseness = (*kind)->coarsest};
  std::vector<Criterion> criteria = (*kind)->criteria;
  std::erase_if(criteria, [](const Criterion& criterion) { return criterion.full_size; });
  const std::vector<Trial> trials = {MustTry(name, setting, VariantsOf(criteria))};
  for (const Criterion& criterion : criteria) ExpectHolds(criterion, trials);
}

// Of all reported seeds and both layouts, at full size.
inline void ExpectCriteriaInFull(const std::string& name) {
  const auto kind = FindDemonstration(name);
  ASSERT_TRUE(kind.ok()) << kind.status();
  for (const MeshLayout layout : kLayouts) {
    std::vector<Trial> trials;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      trials.push_back(MustTry(name, setting, VariantsOf((*kind)->criteria)));
      for (const auto& [variant, metrics] : trials.back().variants)
        Report(absl::StrCat(name, " ", variant), setting, metrics);
    }
    for (const Criterion& criterion : (*kind)->criteria) ExpectHolds(criterion, trials);
  }
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SCENE_TESTING_H_

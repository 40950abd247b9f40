#include "tests/scenes/criteria.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "core/mesh/mesh_check.h"
#include "core/scene/validate.h"
#include "tests/scenes/demonstration.h"

namespace cleave {
namespace {

// Trials that measured `values` of one variant.
std::vector<Trial> TrialsOf(const std::vector<double>& values) {
  std::vector<Trial> trials;
  for (const double value : values) trials.emplace_back().variants["a"]["m"] = value;
  return trials;
}

Criterion AtLeastThree(bool control, double share) {
  return {"m is 3 or more", {"a"}, {{"m", Of("a", "m"), Relation::kAtLeast, 3}}, control, share};
}

TEST(Criteria, HoldInTheShareOfTrialsThatTheyAskFor) {
  const std::vector<Trial> four_of_five = TrialsOf({3, 4, 5, 2, 9});
  EXPECT_TRUE(Judge(AtLeastThree(false, kMost), four_of_five).holds);
  EXPECT_FALSE(Judge(AtLeastThree(false, kAll), four_of_five).holds);
  const std::vector<Trial> three_of_five = TrialsOf({3, 4, 5, 2, 1});
  EXPECT_FALSE(Judge(AtLeastThree(false, kMost), three_of_five).holds);
  EXPECT_TRUE(Judge(AtLeastThree(false, kHalf), three_of_five).holds);
  EXPECT_FALSE(Judge(AtLeastThree(false, kHalf), TrialsOf({3, 3, 1, 1})).holds);
}

TEST(Criteria, ControlsHoldWhereTheyAreNotMet) {
  EXPECT_TRUE(Judge(AtLeastThree(true, kMost), TrialsOf({1, 1, 1, 1, 3})).holds);
  EXPECT_FALSE(Judge(AtLeastThree(true, kMost), TrialsOf({1, 1, 1, 3, 3})).holds);
}

TEST(Criteria, WhatWasNotMeasuredIsNoEvidenceForEither) {
  std::vector<Trial> trials = TrialsOf({1});
  trials[0].variants["a"].clear();
  for (const bool control : {false, true}) {
    const Finding finding = Judge(AtLeastThree(control, kMost), trials);
    EXPECT_FALSE(finding.holds);
    EXPECT_EQ(finding.unmeasured, 1);
    EXPECT_FALSE(Judge(AtLeastThree(control, kMost), {}).holds);
  }
}

TEST(Criteria, AreMetOnlyByAllTheirConditions) {
  Criterion both = AtLeastThree(false, kAll);
  both.conditions.push_back({"m", Of("a", "m"), Relation::kBelow, 5});
  EXPECT_TRUE(Judge(both, TrialsOf({4})).holds);
  EXPECT_FALSE(Judge(both, TrialsOf({5})).holds);
  EXPECT_EQ(both.conditions[1].Bound(), "below 5");
}

TEST(Criteria, OfEveryDemonstrationNameItsOwnVariants) {
  for (const DemonstrationKind& kind : DemonstrationKinds()) {
    const std::set<std::string> variants(kind.variants.begin(), kind.variants.end());
    for (const std::string& variant : VariantsOf(kind.criteria))
      EXPECT_TRUE(variants.contains(variant)) << kind.name << " " << variant;
    for (const Criterion& criterion : kind.criteria) {
      EXPECT_FALSE(criterion.conditions.empty()) << kind.name << ": " << criterion.text;
    }
  }
}

// On the lattice, which is quick to make; short tests have most of the others.
TEST(Criteria, OfEveryDemonstrationHaveBodiesThatTheyCanBeTriedOnWhereTheyAreCoarsest) {
  for (const DemonstrationKind& kind : DemonstrationKinds()) {
    const Setting setting{kind.criteria[0].variants[0], 1, MeshLayout::kJitteredLattice,
                          kind.coarsest};
    const auto made = kind.make(setting);
    ASSERT_TRUE(made.ok()) << kind.name << ": " << made.status();
    TetMesh mesh = made->mesh;
    const Faults faults = CheckAndOrientMesh(mesh);
    EXPECT_TRUE(faults.ok()) << kind.name << ": " << faults.ToStatus();
    EXPECT_TRUE(ValidateSceneWithMesh(made->scene, mesh).ok()) << kind.name;
  }
}

}  // namespace
}  // namespace cleave

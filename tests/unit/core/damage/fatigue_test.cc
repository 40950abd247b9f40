#include "core/damage/fatigue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace cleave {
namespace {

constexpr double kStrength = 1e6;  // Pa

struct Cycle {
  int half_cycles;
  double low, high;
  bool operator==(const Cycle&) const = default;
};

std::vector<Cycle> Count(const std::vector<double>& history) {
  LoadCycles cycles;
  std::vector<Cycle> counted;
  for (const double stress : history) {
    cycles.Follow(stress, [&](int half_cycles, double low, double high) {
      counted.push_back({half_cycles, low, high});
    });
  }
  return counted;
}

// The example of ASTM E1049-85, figure 6, less its closing half cycles, which are still open.
TEST(LoadCycles, CountsTheExampleOfTheStandard) {
  const std::vector<Cycle> expected = {{1, -2, 0}, {1, -2, 1}, {1, -3, 1}, {2, -1, 3}, {1, -3, 5}};
  EXPECT_EQ(Count({-2, 1, -3, 5, -1, 3, -4, 4, -2}), expected);
}

TEST(LoadCycles, ARippleOnASlowCycleIsACycleOfItsOwn) {
  const std::vector<Cycle> expected = {{2, 6, 7}, {1, 0, 10}, {1, 0, 10}};
  EXPECT_EQ(Count({2, 5, 7, 6, 8, 10, 4, 0, 3, 10}), expected);
}

TEST(LoadCycles, AStressThatOnlyRisesCountsNothing) {
  std::vector<double> history;
  for (int k = 0; k < 1000; ++k) history.push_back(k * k);
  EXPECT_TRUE(Count(history).empty());
}

TEST(LoadCycles, SamplesBetweenTurningPointsDoNotCount) {
  const std::vector<double> turning = {4, -2, 6, 1, 2, 0, 5, -7, 7};
  std::vector<double> fine;
  double last = 0;
  for (const double next : turning) {
    for (int k = 1; k <= 8; ++k) fine.push_back(last + k / 8.0 * (next - last));
    fine.back() = next;
    last = next;
  }
  EXPECT_EQ(Count(fine).size(), Count(turning).size());
  double sum = 0, fine_sum = 0;
  for (const Cycle& cycle : Count(turning)) sum += cycle.half_cycles * (cycle.high - cycle.low);
  for (const Cycle& cycle : Count(fine)) fine_sum += cycle.half_cycles * (cycle.high - cycle.low);
  EXPECT_EQ(sum, fine_sum);
}

TEST(LoadCycles, EverSmallerRangesAreCountedFromTheOldestOn) {
  std::vector<double> history;
  for (int k = 0; k < 40; ++k) history.push_back((k % 2 == 0 ? 1 : -1) * std::pow(0.9, k));
  const std::vector<Cycle> counted = Count(history);
  // All but the few that may still be open, each half a cycle.
  EXPECT_GE(counted.size() + LoadCycles::kPoints, history.size());
  for (const Cycle& cycle : counted) EXPECT_EQ(cycle.half_cycles, 1);
}

class Fatigue : public ::testing::Test {
 protected:
  static Broadcast<double> Of(const double& value) { return Broadcast<double>::Uniform(value); }
  bool Follow(FatigueDamage& damage, double stress) const {
    return damage.Follow(std::vector<double>{stress}, Of(strength_), Of(crushing_), Of(kappa_));
  }
  // Cycles between two stresses, Pa, until nothing is left; 0 where `most` do not do.
  int Life(FatigueDamage& damage, double low, double high, int most = 100000) const {
    for (int cycle = 1; cycle <= most; ++cycle) {
      for (const double stress : {high, low}) {
        Follow(damage, stress);
        if (damage.residual_strengths()[0] == 0) return cycle;
      }
    }
    return 0;
  }
  FatigueDamage Make(const FatigueLaw& law) {
    laws_ = {law};
    return FatigueDamage(1, laws_, {});
  }
  // N_f of fully reversed cycles of a relative amplitude.
  static double BasquinLife(const FatigueLaw& law, double amplitude) {
    return 0.5 * std::pow(amplitude / law.coefficient, -law.power);
  }

  double strength_ = kStrength, kappa_ = 1;
  double crushing_ = std::numeric_limits<double>::infinity();
  std::vector<FatigueLaw> laws_;
};

TEST_F(Fatigue, ConstantAmplitudeLastsBasquinsLife) {
  const FatigueLaw law{1.5, 1 / 0.1, 0, 1};
  for (const double amplitude : {0.9, 0.7, 0.6}) {
    FatigueDamage damage = Make(law);
    const int life = Life(damage, -amplitude * kStrength, amplitude * kStrength);
    EXPECT_NEAR(life, std::ceil(BasquinLife(law, amplitude)), 1) << amplitude;
  }
}

TEST_F(Fatigue, PulsatingLoadLastsTheLifeOfSmithWatsonAndTopper) {
  const FatigueLaw law{1.2, 8, 0, 1};
  FatigueDamage damage = Make(law);
  EXPECT_NEAR(Life(damage, 0, 0.8 * kStrength), BasquinLife(law, 0.8 / std::sqrt(2.0)), 1.01);
}

TEST_F(Fatigue, SharesOfLifeAddUpAfterMinerInEitherOrder) {
  const FatigueLaw law{1.5, 10, 0, 1};
  const double lives[2] = {BasquinLife(law, 0.6), BasquinLife(law, 0.75)};
  const double levels[2] = {0.6 * kStrength, 0.75 * kStrength};
  for (const int first : {0, 1}) {
    FatigueDamage damage = Make(law);
    const auto half = static_cast<int>(lives[first] / 2);
    EXPECT_EQ(Life(damage, -levels[first], levels[first], half), 0);
    EXPECT_NEAR(damage.damage(0), 0.5, 0.02);
    const int other = 1 - first;
    EXPECT_NEAR(Life(damage, -levels[other], levels[other]), lives[other] / 2,
                0.02 * lives[other] + 2);
  }
}

TEST_F(Fatigue, BelowTheEnduranceLimitLifeHasNoEnd) {
  FatigueDamage damage = Make({1.5, 10, 0.5, 1});
  EXPECT_EQ(Life(damage, -0.49 * kStrength, 0.49 * kStrength, 20000), 0);
  EXPECT_EQ(damage.damage(0), 0);
  EXPECT_EQ(damage.residual_strengths()[0], 1);
  EXPECT_GT(Life(damage, -0.7 * kStrength, 0.7 * kStrength), 0);
}

TEST_F(Fatigue, CyclesInCompressionDoNothingWhereItNeverBreaks) {
  FatigueDamage damage = Make({1.5, 10, 0, 1});
  EXPECT_EQ(Life(damage, -0.9 * kStrength, 0, 1000), 0);
  EXPECT_EQ(damage.residual_strengths()[0], 1);
}

TEST_F(Fatigue, CyclesInCompressionCountByTheCompressiveStrength) {
  const FatigueLaw law{1.2, 8, 0, 1};
  crushing_ = 4 * kStrength;
  FatigueDamage damage = Make(law);
  const double life = BasquinLife(law, 0.8 / std::sqrt(2.0));
  // A half cycle counts once the next one follows: from 0 on, a cycle later than if pulled.
  EXPECT_NEAR(Life(damage, -0.8 * crushing_, 0), life, 2.01);
  // A weaker bond tires sooner: 0.8 of strength is more of what it has.
  kappa_ = 0.9;
  FatigueDamage weaker = Make(law);
  EXPECT_NEAR(Life(weaker, -0.8 * crushing_, 0), life * std::pow(0.9, 8), 2.01);
}

TEST_F(Fatigue, ACycleTakesTheShareOfItsWorseEnd) {
  const FatigueLaw law{1.5, 10, 0, 1};
  const auto life = [&](double low, double high) {
    FatigueDamage damage = Make(law);
    return Life(damage, low, high);
  };
  const int pulled = life(-0.3 * kStrength, 0.8 * kStrength);
  crushing_ = kStrength;
  EXPECT_EQ(life(-0.3 * kStrength, 0.8 * kStrength), pulled);
  // Each half cycle pairs an end with the other: pressed as hard as pulled, it lasts as long.
  EXPECT_NEAR(life(-0.8 * kStrength, 0.3 * kStrength), pulled, 1);
}

TEST_F(Fatigue, StrengthFallsToTheLoadsPeakAndNeverRises) {
  const FatigueLaw law{1.5, 10, 0, 1};
  FatigueDamage damage = Make(law);
  double last = 1;
  for (int cycle = 0;; ++cycle) {
    Follow(damage, 0.6 * kStrength);
    Follow(damage, -0.6 * kStrength);
    const double left = damage.residual_strengths()[0];
    ASSERT_LE(left, last);
    if (left == 0) break;
    EXPECT_NEAR(left, 1 - 0.4 * damage.damage(0), 1e-12);
    EXPECT_GT(left, 0.6);
    last = left;
  }
  EXPECT_LT(last, 0.61);
  // A peak above all earlier ones leaves what it found.
  FatigueDamage other = Make(law);
  Life(other, -0.5 * kStrength, 0.5 * kStrength, 1000);
  const double weakened = other.residual_strengths()[0];
  EXPECT_LT(weakened, 1);
  Life(other, -0.8 * kStrength, 0.8 * kStrength, 3);
  EXPECT_LE(other.residual_strengths()[0], weakened);
}

TEST_F(Fatigue, ALargeDegradationExponentKeepsStrengthToTheLast) {
  const FatigueLaw law{1.5, 10, 0, 50};
  FatigueDamage damage = Make(law);
  Life(damage, -0.6 * kStrength, 0.6 * kStrength, static_cast<int>(0.8 * BasquinLife(law, 0.6)));
  EXPECT_GT(damage.residual_strengths()[0], 0.9999);
  EXPECT_NEAR(damage.damage(0), 0.8, 0.02);
}

TEST_F(Fatigue, ALifeDoesNotDependOnTheTimeStep) {
  const FatigueLaw law{1.5, 10, 0, 1};
  std::vector<double> sums;
  for (const int samples : {40, 80, 320}) {
    FatigueDamage damage = Make(law);
    for (int k = 0; k <= 30 * samples; ++k) {
      const double time = static_cast<double>(k) / samples;  // of slow cycles
      Follow(damage, kStrength * (0.5 * std::sin(2 * std::numbers::pi * time) +
                                  0.2 * std::sin(2 * std::numbers::pi * 3.7 * time)));
    }
    sums.push_back(damage.damage(0));
  }
  EXPECT_NEAR(sums[1], sums[2], 0.03 * sums[2]);
  EXPECT_NEAR(sums[0], sums[2], 0.12 * sums[2]);
}

TEST_F(Fatigue, WeakerBondsTireSooner) {
  const FatigueLaw law{1.5, 10, 0, 1};
  kappa_ = 0.8;
  FatigueDamage damage = Make(law);
  EXPECT_NEAR(Life(damage, -0.6 * kStrength, 0.6 * kStrength), BasquinLife(law, 0.75), 1.01);
}

TEST_F(Fatigue, OnlyEdgesWithALawTire) {
  laws_ = {{1.5, 10, 0, 1}, {3, 10, 0, 1}};
  const std::vector<int16_t> of_edge = {-1, 1, 0};
  FatigueDamage damage(3, laws_, of_edge);
  for (int cycle = 0; cycle < 100; ++cycle) {
    for (const double stress : {0.7 * kStrength, -0.7 * kStrength})
      damage.Follow(std::vector<double>(3, stress), Of(strength_), Of(crushing_), Of(kappa_));
  }
  EXPECT_EQ(damage.damage(0), 0);
  EXPECT_GT(damage.damage(1), 0);
  EXPECT_NEAR(damage.damage(2) / damage.damage(1), 1024, 1e-6 * 1024);
  EXPECT_EQ(damage.bytes(), FatigueDamage::BytesOf(3));
}

TEST_F(Fatigue, ARestoredStateGoesOnAndADamagedOneIsRefused) {
  FatigueDamage damage = Make({1.5, 10, 0, 1});
  Life(damage, -0.7 * kStrength, 0.65 * kStrength, 100);
  Follow(damage, 0.3 * kStrength);
  std::string saved;
  ByteWriter out(saved);
  damage.Save(out);
  FatigueDamage restored(1, laws_, {});
  ByteReader in(saved);
  ASSERT_TRUE(restored.Restore(in).ok());
  for (int k = 0; k < 10; ++k) {
    const double stress = (k % 2 == 0 ? 0.8 : -0.4) * kStrength;
    EXPECT_EQ(Follow(damage, stress), Follow(restored, stress));
  }
  EXPECT_EQ(damage.damage(0), restored.damage(0));
  EXPECT_EQ(damage.residual_strengths()[0], restored.residual_strengths()[0]);
  std::string broken = saved;
  broken[8 + 40] = 77;  // the number of turning points
  ByteReader bad(broken), half(absl::string_view(saved).substr(0, saved.size() / 2));
  EXPECT_EQ(restored.Restore(bad).code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(restored.Restore(half).code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(damage.damage(0), restored.damage(0));
}

}  // namespace
}  // namespace cleave

#include "core/material/plasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "core/material/corotated_linear.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"
#include "tests/unit/core/material/law_calculus.h"

namespace cleave {
namespace {

constexpr double kYield = 5e6;  // Pa

LameConstants<Double4> Lame() {
  const auto lame = ToLame(1e9, 0.3);
  return {Splat(lame.mu), Splat(lame.lambda)};
}

FlowRule<Double4> Rule(double yield_stress, double hardening, double retained = 0) {
  return {Splat(yield_stress), Splat(hardening), Splat(-std::log(retained))};
}

// One return from F with F_p^-1 = I + B and a plastic strain.
struct Returned {
  Eigen::Matrix3d inverse;  // F_p^-1
  double strain;
};
template <typename Law>
Returned Return(const Eigen::Matrix3d& f, const Returned& from, const FlowRule<Double4>& rule) {
  const Matrix3<Double4> b = DisplacementGradientOf(from.inverse);
  const PlasticReturn flow = ReturnToYield<Law>(DisplacementGradientOf(f * from.inverse), Lame(),
                                                rule, Splat(from.strain));
  return {FirstLane(FlowedInverse(b, flow)) + Eigen::Matrix3d::Identity(),
          from.strain + flow.strain[0]};
}
template <typename Law>
Returned Return(const Eigen::Matrix3d& f, const FlowRule<Double4>& rule) {
  return Return<Law>(f, {Eigen::Matrix3d::Identity(), 0}, rule);
}

template <typename Law>
double VonMisesOf(const Eigen::Matrix3d& elastic) {
  const Eigen::Matrix3d kirchhoff = StressAt<Law>(elastic, Lame()) * elastic.transpose();
  const Eigen::Matrix3d deviator = kirchhoff - kirchhoff.trace() / 3 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

// What an independent implementation of the method note's section 6 found, for the stable
// Neo-Hookean solid of E = 1 GPa and nu = 0.3, a yield stress of 5 MPa and hardening of 20 MPa.
struct ReferenceCase {
  std::array<double, 9> f;
  double flow_rate;  // 1/s
  double dt;         // s
  std::array<double, 9> inverse;
  double strain;
};
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::array<double, 9> kStretch = {1.02, 0, 0, 0, 0.995, 0, 0, 0, 0.995};
constexpr std::array<double, 9> kShear = {1, 0.03, 0, 0, 1, 0.01, 0, 0, 1};
constexpr std::array<double, 9> kTurned = {
    0.713501610447893,  -0.545302896790266, 0.49978942360864,
    0.750325935578851,  0.693235335612236,  -0.0471857662350331,
    -0.371384493868532, 0.352944075188598,  0.864860702953809};
constexpr ReferenceCase kReference[] = {
    {kStretch,
     kInf,
     1,
     {0.988031111644242, 0, 0, 0, 1.00603870601941, 0, 0, 0, 1.00603870601941},
     0.012041092211589952},
    {kStretch,
     50,
     0.01,
     {0.995273405064737, 0, 0, 0, 1.00237170836564, 0, 0, 0, 1.00237170836564},
     0.004737800608833645},
    {kShear,
     kInf,
     1,
     {1.00023188471127, -0.011243972951443, 7.72887853954687e-05, -0.0112439729514432,
      0.999920328451192, -0.00374773335452976, 7.72887853953963e-05, -0.00374773335452969,
      0.999988280763369},
     0.013686485375253066},
    {kShear,
     50,
     0.01,
     {1.00007614920532, -0.00442402078081294, 2.53812515450793e-05, -0.00442402078081305,
      0.999951888999073, -0.00147458898943254, 2.53812515450258e-05, -0.00147458898943248,
      0.999993712363593},
     0.005385212371453516},
    {kTurned,
     kInf,
     1,
     {0.927348841235477, 0, 0, 0, 1.06364489562419, 0, 0, 0, 1.01381848644172},
     0.08035103423620579},
    {kTurned,
     50,
     0.01,
     {0.97075844516014, 0, 0, 0, 1.02457478652907, 0, 0, 0, 1.00541453255771},
     0.0316156684323275}};

TEST(ReturnToYield, MatchesTheReferenceValues) {
  for (const ReferenceCase& reference : kReference) {
    const FlowRule<Double4> rule = Rule(kYield, 2e7, std::exp(-reference.flow_rate * reference.dt));
    const Returned returned = Return<StableNeoHookean>(MatrixOf(reference.f), rule);
    EXPECT_LT((returned.inverse - MatrixOf(reference.inverse)).norm(), 1e-12);
    EXPECT_NEAR(returned.strain, reference.strain, 1e-12);
  }
}

template <typename Law>
class PlasticLaw : public ::testing::Test {};
using Laws =
    ::testing::Types<StableNeoHookean, InvertibleNeoHookean, CorotatedLinear, StVenantKirchhoff>;
TYPED_TEST_SUITE(PlasticLaw, Laws);

const Eigen::Vector3d kStretches[] = {
    {1.02, 1.0, 0.97}, {1.01, 1.01, 0.98}, {1.5, 0.9, 0.8}, {3.0, 0.6, 0.5}, {1.2, 1.1, 1.0}};

TYPED_TEST(PlasticLaw, EndsOnTheYieldSurfaceWithVolumeKept) {
  std::mt19937 random(1);
  for (const Eigen::Vector3d& stretches : kStretches) {
    for (const double hardening : {0.0, 2e7}) {
      const Eigen::Matrix3d f = RandomGradient(random, stretches);
      const Returned returned = Return<TypeParam>(f, Rule(kYield, hardening));
      EXPECT_GT(returned.strain, 0);
      EXPECT_NEAR(returned.inverse.determinant(), 1, 1e-13);
      const double yield = kYield + hardening * returned.strain;
      EXPECT_NEAR(VonMisesOf<TypeParam>(f * returned.inverse), yield, 1e-9 * yield);
    }
  }
}

TYPED_TEST(PlasticLaw, ASecondReturnChangesNothing) {
  std::mt19937 random(2);
  for (const Eigen::Vector3d& stretches : kStretches) {
    const Eigen::Matrix3d f = RandomGradient(random, stretches);
    const Returned once = Return<TypeParam>(f, Rule(kYield, 2e7));
    const Returned twice = Return<TypeParam>(f, once, Rule(kYield, 2e7));
    EXPECT_EQ(twice.strain, once.strain);
    EXPECT_LT((twice.inverse - once.inverse).norm(), 1e-15 * once.inverse.norm());
  }
}

TYPED_TEST(PlasticLaw, RotationsBeforeAndAfterChangeNothing) {
  std::mt19937 random(3);
  for (const Eigen::Vector3d& stretches : kStretches) {
    const Eigen::Matrix3d f = RandomGradient(random, stretches);
    const Eigen::Matrix3d turn = RandomGradient(random, {1, 1, 1});
    const FlowRule<Double4> rule = Rule(kYield, 2e7, 0.3);
    const Returned here = Return<TypeParam>(f, rule);
    const Returned after = Return<TypeParam>(turn * f, rule);
    EXPECT_LT((after.inverse - here.inverse).norm(), 1e-12);
    const Returned before = Return<TypeParam>(f * turn, rule);
    EXPECT_LT((before.inverse - turn.transpose() * here.inverse * turn).norm(), 1e-12);
    EXPECT_NEAR(after.strain, here.strain, 1e-13);
    EXPECT_NEAR(before.strain, here.strain, 1e-13);
  }
}

TYPED_TEST(PlasticLaw, FlowLowersElasticEnergy) {
  std::mt19937 random(4);
  for (const Eigen::Vector3d& stretches : kStretches) {
    const Eigen::Matrix3d f = RandomGradient(random, stretches);
    const Returned returned = Return<TypeParam>(f, Rule(kYield, 2e7));
    EXPECT_LT(EnergyAt<TypeParam>(f * returned.inverse, Lame()), EnergyAt<TypeParam>(f, Lame()));
  }
}

TYPED_TEST(PlasticLaw, BelowYieldInvertedOrCrushedNothingFlows) {
  const auto flows = [&](const Eigen::Matrix3d& f, double yield) {
    const PlasticReturn flow =
        ReturnToYield<TypeParam>(DisplacementGradientOf(f), Lame(), Rule(yield, 0), Splat(0));
    const bool any = flow.strain[0] != 0;
    EXPECT_EQ(FirstLane(flow.change).norm() != 0, any);
    return any;
  };
  std::mt19937 random(5);
  const Eigen::Matrix3d small = RandomGradient(random, {1.001, 1, 1});
  EXPECT_FALSE(flows(small, VonMisesOf<TypeParam>(small) * (1 + 1e-9)));
  EXPECT_TRUE(flows(small, VonMisesOf<TypeParam>(small) * (1 - 1e-6)));
  EXPECT_FALSE(flows(RandomGradient(random, {1.2, 1, -0.3}), kYield));
  EXPECT_FALSE(flows(RandomGradient(random, {1.2, 1, 0.049}), kYield));
  EXPECT_TRUE(flows(RandomGradient(random, {1.2, 1, 0.5}), kYield));
  EXPECT_FALSE(flows(RandomGradient(random, {1, 1, 1}), kYield));
  // Equal pressure from all sides shears nothing.
  EXPECT_FALSE(flows(RandomGradient(random, {0.8, 0.8, 0.8}), kYield));
}

TYPED_TEST(PlasticLaw, WhatOutlivesAStepIsTheRetainedShareOfTheOverstrain) {
  const Eigen::Matrix3d f = Eigen::Vector3d(1.05, 0.98, 0.98).asDiagonal();
  const double at_once = Return<TypeParam>(f, Rule(kYield, 0)).strain;
  EXPECT_NEAR(Return<TypeParam>(f, Rule(kYield, 0, 0.75)).strain, 0.25 * at_once, 1e-13);
  // Many short steps relax it as one long one does.
  Returned slowly = {Eigen::Matrix3d::Identity(), 0};
  for (int step = 0; step < 8; ++step)
    slowly = Return<TypeParam>(f, slowly, Rule(kYield, 0, std::pow(0.75, 0.125)));
  EXPECT_NEAR(slowly.strain, 0.25 * at_once, 1e-3 * at_once);
}

TYPED_TEST(PlasticLaw, ATetDoesNotDependOnItsNeighboursInTheBatch) {
  const Eigen::Matrix3d f = Eigen::Vector3d(1.05, 0.98, 0.97).asDiagonal();
  Matrix3<Double4> mixed = DisplacementGradientOf(f);
  mixed(0, 0) = Double4{mixed(0, 0)[0], 0, 1e200, std::nan("")};
  const FlowRule<Double4> rule = Rule(kYield, 2e7);
  const PlasticReturn among = ReturnToYield<TypeParam>(mixed, Lame(), rule, Splat(0));
  const PlasticReturn alone =
      ReturnToYield<TypeParam>(DisplacementGradientOf(f), Lame(), rule, Splat(0));
  EXPECT_EQ(among.strain[0], alone.strain[0]);
  EXPECT_EQ(among.change(1, 1)[0], alone.change(1, 1)[0]);
  for (int lane = 1; lane < 4; ++lane) EXPECT_TRUE(std::isfinite(among.strain[lane])) << lane;
  EXPECT_EQ(among.strain[3], 0);
}

TEST(IsWithinPlasticRatio, ComparesTheSingularValues) {
  const auto within = [](const Eigen::Vector3d& stretches) {
    std::mt19937 random(6);
    return Any(IsWithinPlasticRatio(DisplacementGradientOf(RandomGradient(random, stretches))));
  };
  EXPECT_TRUE(within({1, 1, 1}));
  EXPECT_TRUE(within({9.9, 1, 0.1}));
  EXPECT_FALSE(within({10.1, 1, 0.1}));
}

}  // namespace
}  // namespace cleave

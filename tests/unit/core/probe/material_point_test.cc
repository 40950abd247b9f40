#include "core/probe/material_point.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <span>

#include "tests/unit/core/material/law_calculus.h"
#include "tests/unit/core/material/reference_values.h"

namespace cleave {
namespace {

Material MaterialOf(ElasticLaw law) {
  Material material;
  material.law = law;
  material.youngs_modulus = reference::kYoungsModulus;
  material.poisson_ratio = reference::kPoissonRatio;
  material.density = 1;
  return material;
}

FibreFamily FamilyOf(double stiffness) {
  FibreFamily family;
  family.stiffness = stiffness;
  return family;
}

Eigen::Matrix3d GradientOf(const Eigen::Matrix3d& f) { return f - Eigen::Matrix3d::Identity(); }

void ExpectNear(const Eigen::Matrix3d& found, const Eigen::Matrix3d& expected, const char* name) {
  EXPECT_LT((found - expected).norm(), 1e-11 * (expected.norm() + reference::kYoungsModulus))
      << name;
}

TEST(MaterialPoint, MatchesTheReferenceEnergiesStressesAndTangents) {
  const std::pair<ElasticLaw, std::span<const reference::Response>> laws[] = {
      {ElasticLaw::kStableNeoHookean, reference::kStableNeoHookean},
      {ElasticLaw::kInvertibleNeoHookean, reference::kInvertibleNeoHookean},
      {ElasticLaw::kCorotatedLinear, reference::kCorotatedLinear}};
  for (const auto& [law, responses] : laws) {
    const MaterialPoint point(MaterialOf(law), {});
    for (size_t k = 0; k < responses.size(); ++k) {
      const auto& [name, entries] = reference::kDeformationGradients[k];
      const Eigen::Matrix3d g = GradientOf(MatrixOf(entries));
      const PointResponse response = point.Respond(g);
      EXPECT_NEAR(response.energy, responses[k].energy, 1e-11 * (1000 + responses[k].energy))
          << name;
      ExpectNear(response.stress, MatrixOf(responses[k].stress), name);
      const auto& eigenvalues = responses[k].eigenvalues;
      if (eigenvalues == std::array<double, 9>{}) continue;  // none is defined there
      const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(point.Tangent(g));
      for (int i = 0; i < 9; ++i) {
        EXPECT_NEAR(solver.eigenvalues()(i), eigenvalues[static_cast<size_t>(i)],
                    1e-11 * (std::abs(eigenvalues[8]) + std::abs(eigenvalues[0])))
            << name;
      }
    }
  }
}

TEST(MaterialPoint, AddsTheReferenceValuesOfFibresToThoseOfTheMatrix) {
  Material material = MaterialOf(ElasticLaw::kStableNeoHookean);
  material.fibres = {FamilyOf(reference::kFibreModulus)};
  const Vec3 direction{reference::kFibreDirection};
  const MaterialPoint point(material, {&direction, 1});
  for (size_t k = 0; k < std::size(reference::kFibre); ++k) {
    const auto& [name, entries] = reference::kDeformationGradients[k];
    const PointResponse response = point.Respond(GradientOf(MatrixOf(entries)));
    EXPECT_NEAR(response.energy,
                reference::kFibre[k].energy + reference::kStableNeoHookean[k].energy,
                1e-11 * (1000 + response.energy))
        << name;
    ExpectNear(response.stress - response.matrix_stress, MatrixOf(reference::kFibre[k].stress),
               name);
    ExpectNear(response.matrix_stress, MatrixOf(reference::kStableNeoHookean[k].stress), name);
  }
}

TEST(MaterialPoint, StressAndTangentAreDerivativesForEveryLawWithTwoFamilies) {
  std::mt19937 random(4);
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff}) {
    Material material = MaterialOf(law);
    material.fibres = {FamilyOf(3000), FamilyOf(500)};
    const Vec3 directions[] = {{1, 2, 0}, {0, -1, 5}};
    const MaterialPoint point(material, directions);
    for (const Eigen::Vector3d& stretches :
         {Eigen::Vector3d(1.4, 1.1, 0.6), Eigen::Vector3d(1.01, 0.99, 0.98),
          Eigen::Vector3d(1.2, 0.8, -0.3)}) {
      const Eigen::Matrix3d g = GradientOf(RandomGradient(random, stretches));
      const Matrix9d tangent = point.Tangent(g);
      const PointResponse response = point.Respond(g);
      Eigen::Matrix3d slope;
      Matrix9d curvature;
      constexpr double h = 1e-6;
      for (int k = 0; k < 9; ++k) {
        Eigen::Matrix3d up = g, down = g;
        up(k / 3, k % 3) += h;
        down(k / 3, k % 3) -= h;
        const PointResponse above = point.Respond(up), below = point.Respond(down);
        slope(k / 3, k % 3) = (above.energy - below.energy) / (2 * h);
        const Eigen::Matrix3d change = (above.stress - below.stress) / (2 * h);
        for (int row = 0; row < 9; ++row) curvature(row, k) = change(row / 3, row % 3);
      }
      EXPECT_LT((response.stress - slope).norm(), 1e-6 * (1000 + slope.norm()));
      EXPECT_LT((tangent - curvature).norm(), 1e-6 * curvature.norm());
    }
  }
}

TEST(MaterialPoint, StressAfterFlowIsTheDerivativeOfEnergyAtThatFlow) {
  Material material = MaterialOf(ElasticLaw::kStableNeoHookean);
  material.plasticity = Plasticity{.yield_stress = 50, .hardening = 20};
  material.fibres = {FamilyOf(300)};
  const Vec3 direction{1, 2, 0};
  const MaterialPoint point(material, {&direction, 1});
  std::mt19937 random(5);
  const Eigen::Matrix3d g = GradientOf(RandomGradient(random, {1.5, 1.0, 0.8}));
  PlasticState plastic;
  ASSERT_TRUE(point.Flow(g, plastic));
  EXPECT_GT(plastic.strain, 0.1);
  EXPECT_NEAR((Eigen::Matrix3d::Identity() + plastic.inverse_change).determinant(), 1, 1e-12);
  PlasticState again = plastic;
  point.Flow(g, again);
  EXPECT_NEAR(again.strain, plastic.strain, 1e-9);  // it was at yield
  Eigen::Matrix3d slope;
  Matrix9d curvature;
  constexpr double h = 1e-6;
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d up = g, down = g;
    up(k / 3, k % 3) += h;
    down(k / 3, k % 3) -= h;
    const PointResponse above = point.Respond(up, plastic), below = point.Respond(down, plastic);
    slope(k / 3, k % 3) = (above.energy - below.energy) / (2 * h);
    const Eigen::Matrix3d change = (above.stress - below.stress) / (2 * h);
    for (int row = 0; row < 9; ++row) curvature(row, k) = change(row / 3, row % 3);
  }
  EXPECT_LT((point.Respond(g, plastic).stress - slope).norm(), 1e-6 * slope.norm());
  EXPECT_LT((point.Tangent(g, plastic) - curvature).norm(), 1e-6 * curvature.norm());
}

}  // namespace
}  // namespace cleave

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <limits>

#include "core/damage/fracture.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Reference values of the method note: stable Neo-Hookean, E = 1000 Pa, nu = 0.3, two unit cells in
// a row under x += .05 X^2 + .03 YZ, y -= .02 XY, z += .04 ZX.
struct EdgeStressRow {
  int32_t i, j;
  double mean, max;
};
constexpr EdgeStressRow kReference[] = {
    {0, 1, 24.59680769230766, 31.654192307692295},
    {0, 2, 45.82953846153844, 61.21538461538464},
    {0, 3, 31.21499664647559, 31.820110511169556},
    {0, 4, 80.60295384615404, 80.60295384615404},
    {0, 5, 63.9022063386758, 77.14157706064594},
    {0, 6, 64.30548271664625, 72.18521316285992},
    {0, 7, 63.10824550457337, 85.02955574459156},
    {1, 3, 31.98595571089769, 31.98595571089769},
    {1, 5, 54.79633348973823, 54.79633348973823},
    {1, 7, 47.779257500325315, 54.62045548462808},
    {2, 3, 30.77600006848381, 30.77600006848381},
    {2, 6, 95.97526509264102, 95.97526509264102},
    {2, 7, 88.27715892798096, 102.78823420521925},
    {3, 7, 67.78735225619437, 68.36325870018663},
    {4, 5, 119.95650974358983, 153.55868307692307},
    {4, 6, 100.96267282051296, 158.56992307692332},
    {4, 7, 93.60632662625987, 135.12488973787228},
    {4, 8, 235.26670769230773, 235.26670769230776},
    {4, 9, 197.72357041028678, 215.6224797434787},
    {4, 10, 194.01696391464944, 205.3979494282967},
    {4, 11, 184.878168339432, 215.59757312995322},
    {5, 7, 49.77668798754323, 115.69253872020367},
    {5, 9, 200.95488549797375, 200.95488549797378},
    {5, 11, 165.55825385007662, 175.6568436055655},
    {6, 7, 105.18091657566333, 152.25783601786384},
    {6, 10, 256.32784882819885, 256.32784882819885},
    {6, 11, 226.4816810133828, 245.90630853784225},
    {7, 11, 219.23213813475155, 219.9416747355299},
    {8, 9, 194.92430769230768, 194.9243076923077},
    {8, 10, 121.212923076923, 121.21292307692302},
    {8, 11, 160.0949796512284, 160.0949796512284},
    {9, 11, 100.72525282609296, 121.5141813821724},
    {10, 11, 206.3277533362574, 217.48596853014772},
};

Vector3d At(const std::vector<Vec3>& positions, int32_t node) {
  return Vector3d(positions[static_cast<size_t>(node)].data());
}

// Stable Neo-Hookean stress of every tet, as in section 5 of the method note.
std::vector<Matrix3d> Stresses(const TetMesh& mesh, const std::vector<Vec3>& positions,
                               double youngs, double poisson) {
  const double mu = youngs / (2 * (1 + poisson));
  const double lambda = youngs * poisson / ((1 + poisson) * (1 - 2 * poisson));
  std::vector<Matrix3d> stresses;
  for (const std::array<int32_t, 4>& tet : mesh.tets) {
    Matrix3d rest, current;
    for (int k = 0; k < 3; ++k) {
      const int32_t node = tet[static_cast<size_t>(k + 1)];
      rest.col(k) = At(mesh.rest_positions, node) - At(mesh.rest_positions, tet[0]);
      current.col(k) = At(positions, node) - At(positions, tet[0]);
    }
    const Matrix3d gradient = current * rest.inverse();
    Matrix3d cofactor;
    cofactor << gradient.col(1).cross(gradient.col(2)), gradient.col(2).cross(gradient.col(0)),
        gradient.col(0).cross(gradient.col(1));
    stresses.push_back(mu * gradient +
                       ((lambda + mu) * (gradient.determinant() - 1) - mu) * cofactor);
  }
  return stresses;
}

class EdgeStressTest : public ::testing::Test {
 protected:
  EdgeStressTest() : mesh_(KuhnBox({2, 1, 1}, {2, 1, 1})), incidence_(BuildIncidence(mesh_)) {
    for (const auto& [x, y, z] : mesh_.rest_positions) {
      positions_.push_back({x + 0.05 * x * x + 0.03 * y * z, y - 0.02 * x * y, z + 0.04 * z * x});
    }
  }
  std::vector<double> EdgeStresses(StressAggregation aggregation,
                                   const std::vector<Vec3>& positions) const {
    EdgeFracture fracture(mesh_, incidence_, Broadcast<double>::Uniform(threshold_),
                          {.aggregation = aggregation});
    std::vector<double> stresses(incidence_.edges.size());
    fracture.EdgeStresses(positions, Stresses(mesh_, positions, 1000, 0.3), nullptr, stresses);
    return stresses;
  }

  TetMesh mesh_;
  Incidence incidence_;
  std::vector<Vec3> positions_;
  double threshold_ = std::numeric_limits<double>::infinity();
};

TEST_F(EdgeStressTest, MeanAndMaxMatchTheReferenceTable) {
  const std::vector<double> mean = EdgeStresses(StressAggregation::kMean, positions_);
  const std::vector<double> max = EdgeStresses(StressAggregation::kMax, positions_);
  ASSERT_EQ(incidence_.edges.size(), std::size(kReference));
  for (size_t edge = 0; edge < std::size(kReference); ++edge) {
    const EdgeStressRow& row = kReference[edge];
    ASSERT_EQ(incidence_.edges[edge], (std::array<int32_t, 2>{row.i, row.j}));
    EXPECT_NEAR(mean[edge], row.mean, 1e-10);
    EXPECT_NEAR(max[edge], row.max, 1e-10);
  }
}

TEST_F(EdgeStressTest, DoesNotChangeUnderRotation) {
  const Matrix3d rotation = Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized()).matrix();
  std::vector<Vec3> rotated = positions_;
  for (Vec3& position : rotated) {
    Eigen::Map<Vector3d> x(position.data());
    x = (rotation * x + Vector3d(3, -1, 2)).eval();
  }
  const std::vector<double> before = EdgeStresses(StressAggregation::kMean, positions_);
  const std::vector<double> after = EdgeStresses(StressAggregation::kMean, rotated);
  for (size_t edge = 0; edge < before.size(); ++edge)
    EXPECT_NEAR(after[edge], before[edge], 1e-12 * 256);
}

TEST_F(EdgeStressTest, InvertedTetsCountAsZero) {
  // Mirrored, every tet has J < 0.
  std::vector<Vec3> mirrored = mesh_.rest_positions;
  for (Vec3& position : mirrored) position[0] *= -1.5;
  for (const double stress : EdgeStresses(StressAggregation::kMean, mirrored)) EXPECT_EQ(stress, 0);
  for (const double stress : EdgeStresses(StressAggregation::kMax, mirrored)) EXPECT_EQ(stress, 0);
}

TEST_F(EdgeStressTest, OfFlowedTetsIsAlongTheDirectionsThatFlowHasTurned) {
  // Tets that flow has sheared by `shear` along x over y, then turned by a right angle about z, and
  // that a small uniaxial stress along y pulls: F_e is 1, so edges lie where flow has put them.
  constexpr double kShear = 0.75, kPull = 8;  // Pa
  Matrix3d turn, sheared = Matrix3d::Identity();
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  sheared(0, 1) = kShear;
  const PlasticTet flowed{turn * sheared, 0};
  const std::vector<PlasticTet> tets(mesh_.tets.size(), flowed);
  std::vector<int32_t> records(mesh_.tets.size());
  for (size_t tet = 0; tet < records.size(); ++tet) records[tet] = static_cast<int32_t>(tet);
  const PlasticTets plastic{records, tets};
  Matrix3d pull = Matrix3d::Zero();
  pull(1, 1) = kPull;
  const std::vector<Matrix3d> stresses(mesh_.tets.size(), pull);
  std::vector<Vec3> positions = mesh_.rest_positions;
  for (Vec3& position : positions) {
    Eigen::Map<Vector3d> x(position.data());
    x = (flowed.deformation * x).eval();
  }
  for (const StressAggregation aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
    EdgeFracture fracture(mesh_, incidence_, Broadcast<double>::Uniform(threshold_),
                          {.aggregation = aggregation});
    std::vector<double> found(incidence_.edges.size());
    fracture.EdgeStresses(positions, stresses, &plastic, found);
    for (size_t edge = 0; edge < found.size(); ++edge) {
      const Vector3d rest = At(mesh_.rest_positions, incidence_.edges[edge][1]) -
                            At(mesh_.rest_positions, incidence_.edges[edge][0]);
      // F_p (a, b, c) = (-b, a + shear b, c).
      const double up = rest[0] + kShear * rest[1];
      const double squares = rest[1] * rest[1] + up * up + rest[2] * rest[2];
      EXPECT_NEAR(found[edge], kPull * up * up / squares, 1e-13);
    }
  }
}

}  // namespace
}  // namespace cleave

#include "core/model/load_terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/counter_rng.h"
#include "core/model/model.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

Double4 Cross(Double4 a, Double4 b) {
  return Double4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
                 0};
}

class LoadTerms : public ::testing::Test {
 protected:
  std::vector<int32_t> NodesWhere(const auto& inside) const {
    std::vector<int32_t> nodes;
    for (size_t node = 0; node < mesh_.rest_positions.size(); ++node) {
      if (inside(mesh_.rest_positions[node])) nodes.push_back(static_cast<int32_t>(node));
    }
    return nodes;
  }
  std::vector<int32_t> AllNodes() const {
    return NodesWhere([](const Vec3&) { return true; });
  }
  std::vector<int32_t> EndNodes() const {
    return NodesWhere([](const Vec3& x) { return x[0] == 3; });
  }
  std::unique_ptr<NodeTerm> Make(LoadKind kind, std::vector<int32_t> nodes) const {
    return MakeLoadTerm({"", kind, {}, {}}, std::move(nodes), mesh_, incidence_, -1);
  }
  NodalVector Zeros() const { return NodalVector(mesh_.rest_positions.size(), Splat(0)); }
  // Displacements of up to `size` (m) along each axis.
  NodalVector Random(double size, uint64_t seed) const {
    NodalVector displacements = Zeros();
    for (size_t node = 0; node < displacements.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis)
        displacements[node][axis] = size * (2 * UniformDraw(seed, RandomStream::kMeshJitter, node,
                                                            static_cast<uint64_t>(axis)) -
                                            1);
    }
    return displacements;
  }
  State At(const NodalVector& displacements) const { return {displacements, Zeros(), {}}; }
  Double4 Position(const NodalVector& displacements, size_t node) const {
    return ToDouble4(mesh_.rest_positions[node]) + displacements[node];
  }

  struct Totals {
    Double4 force = Splat(0), moment = Splat(0);  // about the origin
  };
  Totals Sum(const NodalVector& forces, const NodalVector& displacements) const {
    Totals totals;
    for (size_t node = 0; node < forces.size(); ++node) {
      totals.force += forces[node];
      totals.moment += Cross(Position(displacements, node), forces[node]);
    }
    return totals;
  }
  static void ExpectNear(Double4 actual, const Vec3& expected, double tolerance) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(actual[axis], expected[static_cast<size_t>(axis)], tolerance) << "axis " << axis;
  }

  const TetMesh mesh_ = KuhnBox({3, 2, 2}, {3, 1, 2}, {0, 0.5, 0});
  const Incidence incidence_ = BuildIncidence(mesh_);
};

TEST_F(LoadTerms, APointForceIsSharedEvenlyToTheLastDigit) {
  const auto term = Make(PointForce{{1, -2, 3}}, EndNodes());
  NodalVector forces = Zeros();
  term->BeginStep(0, 1, At(Zeros()));
  EXPECT_EQ(term->AddForces(Zeros(), forces), 0);
  const Totals totals = Sum(forces, Zeros());
  ExpectNear(totals.force, {1, -2, 3}, 1e-12);
  // The mean of the nodes is the middle of the end, (3, 1, 1).
  ExpectNear(totals.moment, {5, -8, -7}, 1e-12);
  for (const int32_t node : EndNodes())
    EXPECT_DOUBLE_EQ(forces[static_cast<size_t>(node)][0], 1.0 / 9);
}

TEST_F(LoadTerms, ATractionPullsAsMuchAsItsAreaAboutItsMiddle) {
  const auto term = Make(SurfaceTraction{{10, 20, -30}}, EndNodes());
  NodalVector forces = Zeros();
  const NodalVector moved = Random(0.3, 1);  // a dead load: it counts at rest
  term->BeginStep(0, 1, At(moved));
  term->AddForces(moved, forces);
  const Totals totals = Sum(forces, Zeros());
  ExpectNear(totals.force, {20, 40, -60}, 1e-12);
  ExpectNear(totals.moment, {1 * -60 - 1 * 40, 1 * 20 + 3 * 60, 3 * 40 - 1 * 20}, 1e-12);
}

TEST_F(LoadTerms, DeadLoadsDoTheWorkOfTheirForces) {
  const auto term = Make(SurfaceTraction{{10, 20, -30}}, EndNodes());
  const NodalVector start = Random(0.3, 1);
  NodalVector end = start;
  for (Double4& displacement : end) displacement += Double4{0.5, 0.25, 0.125, 0};
  term->BeginStep(0, 1, At(start));
  EXPECT_NEAR(term->EndStep(At(end)).external_work, 20 * 0.5 + 40 * 0.25 - 60 * 0.125, 1e-12);
}

TEST_F(LoadTerms, PressureStandsUprightOnEachFace) {
  const auto term = Make(SurfacePressure{7}, EndNodes());
  NodalVector forces = Zeros();
  term->BeginStep(0, 1, At(Zeros()));
  term->AddForces(Zeros(), forces);
  ExpectNear(Sum(forces, Zeros()).force, {-14, 0, 0}, 1e-12);
  // Turned a quarter about z and stretched to twice its width.
  NodalVector turned = Zeros();
  for (size_t node = 0; node < turned.size(); ++node) {
    const Vec3& x = mesh_.rest_positions[node];
    turned[node] = Double4{-x[1], x[0], 2 * x[2], 0} - ToDouble4(x);
  }
  forces = Zeros();
  term->BeginStep(0, 1, At(turned));
  term->AddForces(turned, forces);
  ExpectNear(Sum(forces, turned).force, {0, -28, 0}, 1e-12);
}

TEST_F(LoadTerms, PressureOnAClosedBodyHasNoNetForceAndNoTorque) {
  const auto term = Make(SurfacePressure{1e3}, AllNodes());
  // Also where the body has moved on within the step.
  term->BeginStep(0, 1, At(Random(0.2, 1)));
  for (const uint64_t seed : {1, 2}) {
    const NodalVector moved = Random(0.2, seed);
    NodalVector forces = Zeros();
    term->AddForces(moved, forces);
    double size = 0;
    for (const Double4& force : forces) size += std::sqrt(Dot(force, force));
    ASSERT_GT(size, 1e3);
    const Totals totals = Sum(forces, moved);
    ExpectNear(totals.force, {0, 0, 0}, 1e-12 * size);
    ExpectNear(totals.moment, {0, 0, 0}, 1e-12 * size);
  }
}

TEST_F(LoadTerms, TheEnergyOfPressureOnAClosedBodyIsThatOfItsVolume) {
  const auto term = Make(SurfacePressure{1e3}, AllNodes());
  const auto volume = [&](const NodalVector& displacements) {
    double sum = 0;
    for (const auto& tet : mesh_.tets) {
      const auto corner = [&](size_t k) {
        return Position(displacements, static_cast<size_t>(tet[k]));
      };
      sum += Dot(corner(1) - corner(0), Cross(corner(2) - corner(0), corner(3) - corner(0))) / 6;
    }
    return sum;
  };
  const NodalVector start = Random(0.2, 1), end = Random(0.2, 2);
  term->BeginStep(0, 1, At(start));
  NodalVector forces = Zeros();
  EXPECT_NEAR(term->AddForces(end, forces), 1e3 * (volume(end) - volume(start)), 1e-9);
  double work = 0;
  for (size_t node = 0; node < start.size(); ++node)
    work += Dot(forces[node], end[node] - start[node]);
  EXPECT_NEAR(term->EndStep(At(end)).external_work, work, 1e-9);
}

TEST_F(LoadTerms, ForcesAndStiffnessOfPressureAreSlopesOfItsEnergy) {
  for (const auto& nodes : {AllNodes(), EndNodes()}) {
    const auto term = Make(SurfacePressure{1e3}, nodes);
    term->BeginStep(0, 1, At(Random(0.2, 1)));
    const NodalVector at = Random(0.25, 2), along = Random(1, 3);
    const auto moved = [&](double step) {
      NodalVector displacements = at;
      for (size_t node = 0; node < at.size(); ++node) displacements[node] += step * along[node];
      return displacements;
    };
    NodalVector forces = Zeros(), ahead = Zeros(), behind = Zeros();
    const double h = 1e-4;
    // The energy is cubic: its central difference errs by h^2 and rounding.
    const double slope =
        (term->AddForces(moved(h), ahead) - term->AddForces(moved(-h), behind)) / (2 * h);
    term->AddForces(at, forces);
    NodeCouplings couplings;
    term->AddStiffness(at, Curvature::kSemidefinite, couplings);
    couplings.Gather();
    NodalVector product = Zeros();
    for (const auto& entry : couplings.Rows(0, mesh_.node_count())) {
      const Double4 value = along[static_cast<size_t>(entry.column)];
      for (int k = 0; k < 3; ++k)
        product[static_cast<size_t>(entry.row)] += entry.columns[k] * value[k];
    }
    double work = 0, size = 0;
    for (size_t node = 0; node < at.size(); ++node) {
      work += Dot(forces[node], along[node]);
      size += std::sqrt(Dot(product[node], product[node]));
    }
    EXPECT_NEAR(slope, -work, 1e-7 * size);
    for (size_t node = 0; node < at.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(product[node][axis], -(ahead[node][axis] - behind[node][axis]) / (2 * h),
                    1e-8 * size);
      }
    }
  }
}

TEST_F(LoadTerms, DeadTetsTakeTheirFacesAndLoneNodesTheirShares) {
  std::vector<double> factors(mesh_.tets.size(), 1.0);
  const auto traction = Make(SurfaceTraction{{1, 0, 0}}, EndNodes());
  const auto pressure = Make(SurfacePressure{1}, EndNodes());
  const auto force = Make(PointForce{{9, 0, 0}}, EndNodes());
  // All tets at one end node die.
  const int32_t corner = EndNodes().front();
  double lost_area = 0;
  for (const int32_t tet : incidence_.node_tets[corner]) {
    factors[static_cast<size_t>(tet)] = 0;
    int at_end = 0;
    for (const int32_t node : mesh_.tets[static_cast<size_t>(tet)])
      at_end += mesh_.rest_positions[static_cast<size_t>(node)][0] == 3;
    if (at_end == 3) lost_area += 0.25;  // half of a cell's side
  }
  ASSERT_GT(lost_area, 0);
  for (const auto& [term, total] :
       {std::pair{traction.get(), 2 - lost_area}, std::pair{pressure.get(), -(2 - lost_area)},
        std::pair{force.get(), 8.0}}) {
    term->SetDamage(factors);
    NodalVector forces = Zeros();
    term->BeginStep(0, 1, At(Zeros()));
    term->AddForces(Zeros(), forces);
    ExpectNear(Sum(forces, Zeros()).force, {total, 0, 0}, 1e-12);
    EXPECT_EQ(forces[static_cast<size_t>(corner)][0], 0);
  }
}

TEST_F(LoadTerms, IntensityFollowsItsKeyframesAndEndsWithTheRelease) {
  EXPECT_EQ(IntensityAt({}, 5), 1);
  const std::vector<LoadKeyframe> keyframes = {{1, 0}, {3, 4}};
  EXPECT_EQ(IntensityAt(keyframes, 0), 0);
  EXPECT_EQ(IntensityAt(keyframes, 1.5), 1);
  EXPECT_EQ(IntensityAt(keyframes, 9), 4);
  for (const LoadKind& kind : {LoadKind(PointForce{{0, 2, 0}}), LoadKind(SurfacePressure{1})}) {
    const auto term = MakeLoadTerm({"", kind, keyframes, {}}, EndNodes(), mesh_, incidence_, 0);
    State state = At(Zeros());
    state.released = {0};
    const auto size = [&] {
      NodalVector forces = Zeros();
      term->BeginStep(1, 2, state);
      term->AddForces(Zeros(), forces);
      const Totals totals = Sum(forces, Zeros());
      return std::sqrt(Dot(totals.force, totals.force));
    };
    EXPECT_NEAR(size(), 4, 1e-12);  // that of the step's end
    state.released = {1};
    EXPECT_EQ(size(), 0);
    EXPECT_EQ(term->EndStep(state).external_work, 0);
  }
}

}  // namespace
}  // namespace cleave

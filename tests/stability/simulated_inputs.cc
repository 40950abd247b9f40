#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "tests/stability/hostile_input.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

using Check = std::function<std::string(const Simulation&)>;

HostileInput Runs(int number, const char* name, int frames, std::function<HostileBody()> make,
                  Check check = {}) {
  return {number, name, Verdict::kSimulated, "", "", frames, std::move(make), std::move(check)};
}

HostileBody Changed(HostileBody body, const std::function<void(HostileBody&)>& change) {
  change(body);
  return body;
}

void AddMesh(TetMesh& mesh, const TetMesh& other, int32_t first_node) {
  for (auto tet : other.tets) {
    for (int32_t& node : tet) node += first_node;
    mesh.tets.push_back(tet);
  }
}

HostileBody ScaledCube(double size) {
  HostileBody body = SoftCube();
  body.scene.materials[0].youngs_modulus = 1e5 * std::max(1.0, size);
  body.mesh = KuhnBox({3, 3, 3}, {size, size, size});
  body.scene.node_sets[0].select = {BoxSelector{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e-6 * size}}};
  return body;
}

HostileBody StiffCube(double youngs_modulus) {
  return Changed(SoftCube(), [&](HostileBody& b) {
    b.scene.materials[0].youngs_modulus = youngs_modulus;
    b.scene.quality.newton_iterations = 100;
  });
}

HostileBody ImpureCube(double share, double noise) {
  return Changed(SoftCube(), [&](HostileBody& b) {
    b.scene.materials[0].tensile_strength = 1e3;
    Impurities& impurities = b.scene.impurities.emplace();
    impurities.potency = 100;
    impurities.noise = noise;
    impurities.map.assign(64, share);
    AddBoxSet(b.scene, "lid", {-1, -1, 1 - 1e-9}, {2, 2, 2});
    AddMotion(b.scene, "lid").keyframes = {{0, {0, 0, 0}, 0}, {0.1, {0, 0, 0.5}, 0}};
  });
}

// The drop of backward Euler, g dt^2 n (n + 1) / 2, to what a float solve leaves of it.
Check FallsFreely(size_t node, double height, int frames) {
  return [=](const Simulation& simulation) -> std::string {
    const double expected = height - 9.81 * 1e-4 * frames * (frames + 1) / 2;
    const double at = simulation.positions()[node][2];
    return std::abs(at - expected) < 1e-4
               ? ""
               : absl::StrCat("is at ", at, " m where free fall leads to ", expected);
  };
}

std::string AllBroken(const Simulation& simulation) {
  const auto nodes = static_cast<int64_t>(simulation.positions().size());
  return simulation.fragments() == nodes ? "" : absl::StrCat(simulation.fragments(), " pieces");
}

std::string StaysNear(const Simulation& simulation) {
  for (const Vec3& position : simulation.positions()) {
    for (const double coordinate : position) {
      if (!(std::abs(coordinate) < 10)) return absl::StrCat("a node is at ", coordinate, " m");
    }
  }
  return "";
}

// m/s, of any node, in the cube's 0.2 s.
Check IsPushedOffAtNoMoreThan(double speed) {
  return [=](const Simulation& simulation) -> std::string {
    const std::vector<Vec3> rest = KuhnBox({3, 3, 3}, {1, 1, 1}).rest_positions;
    double farthest = 0;
    for (size_t node = 0; node < rest.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis)
        farthest =
            std::max(farthest, std::abs(simulation.positions()[node][axis] - rest[node][axis]));
    }
    return farthest < 0.2 * speed ? "" : absl::StrCat("a node went ", farthest, " m");
  };
}

HostileBody CrossingEnds() {
  HostileBody body;
  body.scene = TightScene(1e4, 0.3, 1000, 0.01);
  body.scene.quality = Quality{};
  body.scene.quality.newton_iterations = 100;
  body.scene.mesh.source = MeshAsset{std::string(64, '0')};
  body.mesh = KuhnBox({6, 2, 2}, {3, 1, 1});
  body.scene.materials[0].tensile_strength = 2e3;
  AddBoxSet(body.scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(body.scene, "right", {3 - 1e-9, -1, -1}, {4, 2, 2});
  AddMotion(body.scene, "left");
  AddMotion(body.scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.4, {-4, 0, 0}, 0}};
  return body;
}

// All nodes of a tet in a corner of the cube are led to one point.
HostileBody CollapsedCorner() {
  HostileBody body = CrushedCube(0);
  body.scene.motions.clear();
  const std::array<int32_t, 4> tet = body.mesh.tets[0];
  const Vec3 end = body.mesh.rest_positions[static_cast<size_t>(tet[0])];
  for (const int32_t node : tet) {
    const Vec3& from = body.mesh.rest_positions[static_cast<size_t>(node)];
    NodeSet set;
    set.name = absl::StrCat("node ", node);
    set.select = {IdSelector{{node}}};
    body.scene.node_sets.push_back(set);
    AddMotion(body.scene, set.name).keyframes = {
        {0, {0, 0, 0}, 0}, {0.2, {end[0] - from[0], end[1] - from[1], end[2] - from[2]}, 0}};
  }
  return body;
}

}  // namespace

std::vector<HostileInput> SimulatedInputs() {
  using Body = HostileBody;
  std::vector<HostileInput> inputs;
  const auto add = [&inputs](HostileInput input) { inputs.push_back(std::move(input)); };

  add(Runs(
      5, "StrengthWeakeningFlowAndFailureStrainMayBeInfinite", 10,
      [] {
        return Changed(CrushedCube(-0.5), [](Body& b) {
          b.scene.materials[0].tensile_strength = 1e5;
          b.scene.materials[0].plasticity = Plasticity{
              .yield_stress = 5e4, .hardening = 1e4, .flow_rate = kInf, .failure_strain = kInf};
          b.scene.weakenings.push_back({BoxSelector{{-9, -9, -9}, {9, 9, 9}}, kInf});
        });
      },
      [](const Simulation& s) -> std::string {
        const std::vector<double> strains = s.plastic_strains();
        if (*std::max_element(strains.begin(), strains.end()) == 0) return "nothing flowed";
        return s.broken_edges().empty() ? "" : "something broke";
      }));
  add(Runs(29, "StiffnessOfAMillipascal", 5, [] { return StiffCube(1e-3); }));
  add(Runs(29, "StiffnessOfTenTerapascals", 5, [] { return StiffCube(1e13); }));
  add(Runs(30, "StepsOfATenthOfAMicrosecond", 5, [] {
    return Changed(SoftCube(), [](Body& b) { b.scene.timing.frames_per_second = 1e7; });
  }));
  add(Runs(31, "ANanometreWide", 5, [] { return ScaledCube(1e-9); }));
  add(Runs(31, "AThousandKilometresWide", 5, [] { return ScaledCube(1e6); }));
  add(Runs(
      32, "FarFromTheOrigin", 10,
      [] {
        return Changed(FreeCube(), [](Body& b) {
          for (Vec3& p : b.mesh.rest_positions)
            for (double& x : p) x += 0x1.0p20;
        });
      },
      FallsFreely(0, 0x1.0p20, 10)));
  add(Runs(33, "OneTet", 20, [] {
    return Changed(SoftCube(), [](Body& b) {
      b.mesh = TetMesh{};
      b.mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      b.mesh.tets = {{0, 1, 2, 3}};
    });
  }));
  add(Runs(
      34, "TwoBodiesThatDoNotTouch", 10,
      [] {
        return Changed(SoftCube(), [](Body& b) {
          const TetMesh other = KuhnBox({1, 1, 1}, {1, 1, 1}, {5, 0, 3});
          AddMesh(b.mesh, other, static_cast<int32_t>(b.mesh.node_count()));
          for (const Vec3& p : other.rest_positions) b.mesh.rest_positions.push_back(p);
        });
      },
      FallsFreely(64, 3, 10)));
  add(Runs(35, "BlocksJoinedByANode", 20, [] {
    return Changed(SoftCube(), [](Body& b) {
      b.mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
      const TetMesh other = KuhnBox({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
      for (auto tet : other.tets) {
        for (int32_t& node : tet) node = node == 0 ? 7 : node + 7;
        b.mesh.tets.push_back(tet);
      }
      for (size_t n = 1; n < other.rest_positions.size(); ++n)
        b.mesh.rest_positions.push_back(other.rest_positions[n]);
    });
  }));
  add(Runs(35, "TetsJoinedByAnEdge", 20, [] {
    return Changed(SoftCube(), [](Body& b) {
      b.mesh = TetMesh{};
      b.mesh.rest_positions = {{0, 0, 0},   {0, 0, 1},    {1, 0, 0.5},
                               {0, 1, 0.5}, {-1, 0, 0.5}, {0, -1, 0.5}};
      b.mesh.tets = {{0, 1, 2, 3}, {0, 1, 4, 5}};
    });
  }));
  add(Runs(
      36, "AllNodesPinnedAndStillTheStressBreaks", 10,
      [] {
        return Changed(SoftCube(), [](Body& b) {
          b.scene.materials[0].tensile_strength = 3e4;
          AddBoxSet(b.scene, "rest", {-1, -1, 0.1}, {2, 2, 2});
          AddMotion(b.scene, "rest").keyframes = {{0, {0, 0, 0}, 0}, {0.1, {0, 0, 0.5}, 0}};
        });
      },
      [](const Simulation& s) -> std::string {
        return s.broken_edges().empty() ? "nothing broke" : "";
      }));
  add(Runs(37, "NothingPinned", 10, FreeCube, FallsFreely(0, 0, 10)));
  add(Runs(38, "PotencyOfNothing", 10, [] { return ImpureCube(1e-302, 0); }));
  // Larger ones than scenes may ask for, to 1e300: BondStrength.IsMonotoneInPotencyAndBonds.
  add(Runs(38, "PotencyAsLargeAsScenesMayAskFor", 10, [] { return ImpureCube(1, 10); }));
  add(Runs(
      39, "NoStrength", 10,
      [] {
        return Changed(FreeCube(), [](Body& b) { b.scene.materials[0].tensile_strength = 0; });
      },
      AllBroken));
  add(Runs(
      40, "InfiniteStrength", 10,
      [] {
        return Changed(CrushedCube(-0.5),
                       [](Body& b) { b.scene.materials[0].tensile_strength = kInf; });
      },
      [](const Simulation& s) -> std::string {
        return s.broken_edges().empty() ? "" : "something broke";
      }));
  add(Runs(
      41, "EveryEdgeCutBeforeTheStart", 10,
      [] {
        return Changed(FreeCube(), [](Body& b) {
          b.scene.weakenings.push_back({BoxSelector{{-9, -9, -9}, {9, 9, 9}}, 0});
        });
      },
      AllBroken));
  add(Runs(
      42, "CrushedToAFifth", 30, [] { return CrushedCube(0.8); }, StaysNear));
  add(Runs(
      42, "PressedFlat", 30, [] { return CrushedCube(1); }, StaysNear));
  add(Runs(42, "CollapsedToAPoint", 30, CollapsedCorner, StaysNear));
  add(Runs(
      42, "TurnedInsideOut", 30, [] { return CrushedCube(1.5); }, StaysNear));
  add(Runs(43, "PinnedEndsThatCross", 40, CrossingEnds, StaysNear));
  add(Runs(
      44, "AColliderStartsInsideTheBody", 20,
      [] {
        return Changed(FreeCube(), [](Body& b) {
          Collider ball;
          ball.shape = SphereShape{{0.5, 0.5, 0.5}, 0.3};
          b.scene.colliders.push_back(ball);
          b.scene.quality.newton_iterations = 100;
        });
      },
      IsPushedOffAtNoMoreThan(60)));
  add(Runs(
      45, "NothingMoves", 10,
      [] {
        return Changed(FreeCube(), [](Body& b) {
          b.scene.gravity.reset();
          b.scene.materials[0].tensile_strength = 1;
        });
      },
      [](const Simulation& s) -> std::string {
        return s.positions() == KuhnBox({3, 3, 3}, {1, 1, 1}).rest_positions ? "" : "a node moved";
      }));
  return inputs;
}

}  // namespace cleave

// Tries every hostile input in both precisions, and prints what came of each as a table.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/mesh_limits.h"
#include "core/scene/validate.h"
#include "tests/stability/balances.h"
#include "tests/stability/hostile_input.h"

namespace cleave {
namespace {

std::vector<HostileInput> AllInputs() {
  std::vector<HostileInput> inputs = RefusedInputs();
  for (const auto& more : {WarnedInputs(), SimulatedInputs()})
    inputs.insert(inputs.end(), more.begin(), more.end());
  return inputs;
}

struct Trial {
  HostileInput input;
  Precision precision;
};

std::vector<Trial> AllTrials() {
  std::vector<Trial> trials;
  for (const HostileInput& input : AllInputs()) {
    for (const Precision precision : {Precision::kDouble, Precision::kFloat})
      trials.push_back({input, precision});
  }
  return trials;
}

const char* NameOf(Precision precision) {
  return precision == Precision::kFloat ? "float" : "double";
}

std::string NameOf(const Trial& trial) {
  const char* in = trial.precision == Precision::kFloat ? "InFloat" : "InDouble";
  return absl::StrCat("Item", trial.input.number, trial.input.name, in);
}

void PrintTo(const Trial& trial, std::ostream* out) { *out << NameOf(trial); }

// The rows of the table, in the order of the trials.
std::vector<std::string>& Rows() {
  static std::vector<std::string> rows;
  return rows;
}

void AddRow(int number, const char* name, const char* must, const char* precision,
            const std::string& came_out) {
  char row[600];
  std::snprintf(row, sizeof(row), "%4d  %-40s %-9s %-7s %s", number, name, must, precision,
                came_out.c_str());
  Rows().push_back(row);
}

class PrintTable : public ::testing::Environment {
 public:
  void TearDown() override {
    if (Rows().size() < 2) return;
    std::printf("\n%4s  %-40s %-9s %-7s %s\n", "item", "input", "must be", "in", "came out");
    for (const std::string& row : Rows()) std::printf("%s\n", row.c_str());
  }
};
const auto* const kTable = ::testing::AddGlobalTestEnvironment(new PrintTable);

Faults Validate(HostileBody& body) {
  Faults faults;
  faults.Append("", CheckAndOrientMesh(body.mesh));
  faults.Append("", ValidateScene(body.scene));
  if (faults.ok()) faults.Append("", ValidateSceneWithMesh(body.scene, body.mesh));
  return faults;
}

const Fault* Find(const std::vector<Fault>& faults, const HostileInput& input) {
  for (const Fault& fault : faults) {
    if (fault.field == input.field && absl::StrContains(fault.description, input.says))
      return &fault;
  }
  return nullptr;
}

bool AllFinite(const FrameReport& report, const Simulation& simulation) {
  double sum = report.kinetic_energy + report.elastic_energy + report.external_work +
               report.fracture_energy + report.plastic_work + report.contact_energy +
               report.friction_dissipation + report.integration_dissipation + report.residual;
  const auto add = [&sum](const std::vector<Vec3>& vectors) {
    for (const Vec3& vector : vectors) sum += vector[0] + vector[1] + vector[2];
  };
  add(simulation.positions());
  add(report.motion_forces);
  for (const double strain : simulation.plastic_strains()) sum += strain;
  return std::isfinite(sum);
}

class HostileInputTest : public ::testing::TestWithParam<Trial> {
 protected:
  // Simulates the frames on `threads`; returns the hash at the end, 0 after a failure.
  uint64_t Simulate(const HostileBody& body, int threads, std::string& came_out) {
    const HostileInput& input = GetParam().input;
    auto created = Simulation::Create(body.scene, body.mesh, {threads});
    EXPECT_TRUE(created.ok()) << created.status();
    if (!created.ok()) return 0;
    const std::unique_ptr<Simulation> simulation = *std::move(created);
    const StopFlag stop;
    MomentumBalance momentum(body);
    EnergyBalance energy;
    double worst_residual = 0;
    int64_t broken = 0;
    int halvings = 0;
    for (int frame = 0; frame < input.frames; ++frame) {
      const auto report = simulation->Advance(stop);
      EXPECT_TRUE(report.ok()) << "frame " << frame << ": " << report.status();
      if (!report.ok()) return 0;
      EXPECT_TRUE(AllFinite(*report, *simulation)) << "frame " << frame;
      EXPECT_GE(report->broken_edges, broken) << "a broken edge mended";
      EXPECT_LE(momentum.Excess(*report, simulation->positions()), 2) << "frame " << frame;
      EXPECT_LE(energy.Gap(*report), 3 * body.scene.quality.residual_tolerance)
          << "frame " << frame;
      EXPECT_LE(energy.Made(), 1e-4) << "frame " << frame;
      broken = report->broken_edges;
      halvings += report->step_halvings;
      worst_residual = std::max(worst_residual, report->residual);
    }
    if (input.check) {
      EXPECT_EQ(input.check(*simulation), "");
    }
    came_out = absl::StrCat(input.frames, " frames, residual ", worst_residual, ", ", halvings,
                            " halvings, ", broken, " edges broken");
    return simulation->state_hash();
  }
};

TEST_P(HostileInputTest, ComesOutAsItMust) {
  const HostileInput& input = GetParam().input;
  HostileBody body = input.make();
  body.scene.quality.precision = GetParam().precision;
  const Faults faults = Validate(body);
  std::string came_out;
  const char* must = "refused";
  if (input.verdict == Verdict::kRefused) {
    const Fault* fault = Find(faults.errors(), input);
    ASSERT_NE(fault, nullptr) << faults.ToStatus();
    came_out = absl::StrCat(fault->field, ": ", fault->description);
  } else {
    must = "simulated";
    ASSERT_TRUE(faults.ok()) << faults.ToStatus();
    if (input.verdict == Verdict::kWarned) {
      must = "warned";
      EXPECT_NE(Find(faults.warnings(), input), nullptr);
    }
    const uint64_t hash = Simulate(body, 1, came_out);
    std::string again;
    EXPECT_EQ(Simulate(body, 2, again), hash) << "on two threads";
  }
  AddRow(input.number, input.name, must, NameOf(GetParam().precision),
         (HasFailure() ? "FAILED: " : "") + came_out);
}

INSTANTIATE_TEST_SUITE_P(MethodNote, HostileInputTest, ::testing::ValuesIn(AllTrials()),
                         [](const auto& trial) { return NameOf(trial.param); });

// 17 asks for more memory than machines have; what refuses it needs no mesh.
TEST(HostileInput, Item17MoreNodesAndTetsThanIdsCanCountAreRefused) {
  EXPECT_TRUE(CheckMeshCounts(limits::kMaxNodes, limits::kMaxTets).ok());
  const Faults faults = CheckMeshCounts(limits::kMaxNodes + 1, limits::kMaxTets + 1);
  ASSERT_EQ(faults.error_count(), 2);
  const Fault& fault = faults.errors()[0];
  AddRow(17, "MoreNodesAndTetsThanIdsCanCount", "refused", "either",
         absl::StrCat(fault.field, ": ", fault.description));
}

TEST(HostileInput, EveryItemOfTheNoteIsTried) {
  std::vector<int> missing;
  const std::vector<HostileInput> inputs = AllInputs();
  for (int number = 1; number <= 45; ++number) {
    const bool tried =
        number == 17 || std::any_of(inputs.begin(), inputs.end(),
                                    [&](const auto& i) { return i.number == number; });
    if (!tried) missing.push_back(number);
  }
  EXPECT_EQ(missing, std::vector<int>{});
}

}  // namespace
}  // namespace cleave

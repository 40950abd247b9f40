#include "tests/scenes/noise_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "core/base/status.h"
#include "tests/metrics/statistics.h"
#include "tests/scenes/tube.h"

namespace cleave {
namespace {

constexpr size_t kRuns = 10;  // of each model
constexpr size_t kLengths = 20;
constexpr size_t kBins = 4 * kLengths;
constexpr double kCell = 0.17;  // m
constexpr double kPotency = 0.12;
constexpr double kNoise = 0.1;  // standard deviation

std::string BinName(size_t bin) { return absl::StrFormat("damage_%03d", bin); }

size_t BinOf(const Vec3& x) {
  const double along = (x[0] / kTubeLength + 0.5) * kLengths;
  const auto length = static_cast<size_t>(std::clamp(along, 0.0, kLengths - 1.0));
  return 4 * length + (x[1] > 0 ? 1 : 0) + (x[2] > 0 ? 2 : 0);
}

std::vector<std::string> RunsOf(const std::string& model) {
  std::vector<std::string> runs;
  for (size_t run = 1; run <= kRuns; ++run) runs.push_back(absl::StrCat(model, "-", run));
  return runs;
}

// Euclidean distances between fields of damage; not a number where a run is missing.
GroupComparison Compare(const Trial& trial, const std::string& model) {
  std::vector<std::array<double, kBins>> fields;
  for (const std::string& group : {std::string("gaussian"), model}) {
    for (const std::string& run : RunsOf(group)) {
      for (size_t bin = 0; bin < kBins; ++bin) {
        if (bin == 0) fields.emplace_back();
        fields.back()[bin] = trial.Get(run, BinName(bin));
        if (std::isnan(fields.back()[bin])) {
          const double none = std::numeric_limits<double>::quiet_NaN();
          return {none, none, none};
        }
      }
    }
  }
  return CompareGroups(
      fields.size(), kRuns,
      [&](size_t i, size_t j) {
        double square = 0;
        for (size_t bin = 0; bin < kBins; ++bin)
          square += (fields[i][bin] - fields[j][bin]) * (fields[i][bin] - fields[j][bin]);
        return std::sqrt(square);
      },
      trial.setting.seed);
}

double MeanPieces(const Trial& trial, const std::string& model) {
  double sum = 0;
  for (const std::string& run : RunsOf(model)) sum += trial.Get(run, "pieces");
  return sum / kRuns;
}

std::vector<Condition> SameAsGaussian(const std::string& model) {
  return {{"distance of damage between models, over that within",
           [model](const Trial& trial) {
             const GroupComparison found = Compare(trial, model);
             return found.between / found.within;
           },
           Relation::kAtMost, 1.2},
          {"p of a permutation test of the two",
           [model](const Trial& trial) { return Compare(trial, model).p; }, Relation::kAbove, 0.05},
          {"mean pieces over those of Gaussian noise, from 1",
           [model](const Trial& trial) {
             return std::abs(MeanPieces(trial, model) / MeanPieces(trial, "gaussian") - 1);
           },
           Relation::kAtMost, 0.2}};
}

}  // namespace

std::vector<std::string> NoiseModelsVariants() {
  std::vector<std::string> variants;
  for (const char* model : {"gaussian", "uniform", "strong"}) {
    for (const std::string& run : RunsOf(model)) variants.push_back(run);
  }
  return variants;
}

absl::StatusOr<Demonstration> MakeNoiseModels(const Setting& setting) {
  const std::vector<std::string> words = absl::StrSplit(setting.variant, '-');
  uint32_t run = 0;
  if (words.size() != 2 || !absl::SimpleAtoi(words[1], &run))
    return absl::NotFoundError(absl::StrCat("no variant is called ", setting.variant));
  Impurities impurities;
  impurities.potency = kPotency;
  impurities.noise = words[0] == "strong" ? 3 * kNoise : kNoise;
  if (words[0] == "uniform") impurities.distribution = NoiseDistribution::kUniform;
  CLEAVE_ASSIGN_OR_RETURN(Demonstration made,
                          MakeTubeOf(setting, kCell, impurities, 100 * setting.seed + run));
  made.frames_after_separation = 5;
  made.scene.name = words[0] == "uniform" ? "uniform noise" : "Gaussian noise";
  return made;
}

Metrics MeasureNoiseModels(const Demonstration& demonstration, const Incidence& incidence,
                           const Run& run) {
  std::array<double, kBins> all{}, broken{};
  const auto bin_of = [&](int32_t edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    Vec3 middle{0, 0, 0};
    for (const int32_t node : {a, b}) {
      for (size_t axis = 0; axis < 3; ++axis)
        middle[axis] += demonstration.mesh.rest_positions[static_cast<size_t>(node)][axis] / 2;
    }
    return BinOf(middle);
  };
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge)
    all[bin_of(static_cast<int32_t>(edge))] += 1;
  for (const int32_t edge : run.frames.back().broken_edges) broken[bin_of(edge)] += 1;
  Metrics metrics;
  for (size_t bin = 0; bin < kBins; ++bin)
    metrics[BinName(bin)] = all[bin] > 0 ? broken[bin] / all[bin] : 0;
  return metrics;
}

std::vector<Criterion> NoiseModelsCriteria() {
  std::vector<std::string> same = RunsOf("gaussian"), other = same;
  for (const std::string& run : RunsOf("uniform")) same.push_back(run);
  for (const std::string& run : RunsOf("strong")) other.push_back(run);
  return {
      {"Uniform noise breaks it as Gaussian noise of the same variance does", same,
       SameAsGaussian("uniform")},
      {"Gaussian noise of another variance does not", other, SameAsGaussian("strong"), true},
  };
}

}  // namespace cleave

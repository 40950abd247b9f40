#include "client/cli/run_plot.h"

#include <cmath>
#include <optional>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "client/io/scene/json_scanner.h"

namespace cleave {
namespace {

bool ReadDouble(JsonScanner& scanner, double& value) {
  if (scanner.Peek() == JsonScanner::Kind::kNull) {
    value = 0;
    return scanner.ReadNull();
  }
  absl::string_view digits;
  return scanner.ReadNumber(digits) && absl::SimpleAtod(digits, &value);
}

// [[x, y, z], ...]: the force of each motion.
bool ReadForces(JsonScanner& scanner, std::vector<Vec3>& forces) {
  if (!scanner.BeginArray()) return false;
  JsonScanner::Cursor rows;
  while (scanner.NextItem(rows)) {
    if (!scanner.BeginArray()) return false;
    JsonScanner::Cursor cells;
    Vec3 force{0, 0, 0};
    for (size_t axis = 0; scanner.NextItem(cells); ++axis) {
      if (axis >= 3 || !ReadDouble(scanner, force[axis])) return false;
    }
    forces.push_back(force);
  }
  return !scanner.failed();
}

std::optional<PlotSample> SampleOfLine(absl::string_view line, const Pull& pull) {
  JsonScanner scanner(line);
  JsonScanner::Cursor cursor;
  if (scanner.Peek() != JsonScanner::Kind::kObject || !scanner.BeginObject()) return std::nullopt;
  PlotSample sample;
  std::vector<Vec3> forces;
  std::string name;
  while (scanner.NextMember(cursor, name)) {
    double value = 0;
    if (name == "motion_forces") {
      if (!ReadForces(scanner, forces)) return std::nullopt;
    } else if (name == "time" || name == "broken_edges" || name == "fragments") {
      if (!ReadDouble(scanner, value)) return std::nullopt;
      if (name == "time") sample.time = value;
      if (name == "broken_edges") sample.broken_edges = std::llround(value);
      if (name == "fragments") sample.pieces = std::llround(value);
    } else if (!scanner.SkipValue()) {
      return std::nullopt;
    }
  }
  if (scanner.failed()) return std::nullopt;
  if (pull.motion >= 0 && pull.motion < static_cast<int64_t>(forces.size())) {
    const Vec3& force = forces[static_cast<size_t>(pull.motion)];
    for (size_t axis = 0; axis < 3; ++axis) sample.force += force[axis] * pull.direction[axis];
  }
  return sample;
}

}  // namespace

Pull FarthestPull(const std::vector<Motion>& motions) {
  Pull pull;
  double farthest = 0;
  for (size_t i = 0; i < motions.size(); ++i) {
    for (const Keyframe& keyframe : motions[i].keyframes) {
      const Vec3& way = keyframe.translation;
      const double length = std::hypot(way[0], way[1], way[2]);
      if (!(length > farthest)) continue;
      farthest = length;
      pull.motion = static_cast<int64_t>(i);
      pull.direction = {way[0] / length, way[1] / length, way[2] / length};
    }
  }
  return pull;
}

absl::StatusOr<std::vector<PlotSample>> SamplesOfReports(absl::string_view report_lines,
                                                         const Scene& scene) {
  const Pull pull = FarthestPull(scene.motions);
  std::vector<PlotSample> samples;
  for (const absl::string_view line : absl::StrSplit(report_lines, '\n', absl::SkipEmpty())) {
    const std::optional<PlotSample> sample = SampleOfLine(line, pull);
    if (sample.has_value()) samples.push_back(*sample);
  }
  if (samples.empty()) return absl::InvalidArgumentError("the reports have no whole line");
  return samples;
}

}  // namespace cleave

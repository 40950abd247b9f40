#include "client/cli/run_colliders.h"

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "client/io/scene/json_scanner.h"

namespace cleave {
namespace {

bool ReadNumber(JsonScanner& scanner, double& value) {
  absl::string_view digits;
  return scanner.ReadNumber(digits) && absl::SimpleAtod(digits, &value);
}

// Exactly as many numbers as there are values.
bool ReadNumbers(JsonScanner& scanner, std::span<double> values) {
  if (!scanner.BeginArray()) return false;
  JsonScanner::Cursor cursor;
  size_t count = 0;
  while (scanner.NextItem(cursor)) {
    if (count >= values.size() || !ReadNumber(scanner, values[count])) return false;
    ++count;
  }
  return !scanner.failed() && count == values.size();
}

bool ReadPlaces(JsonScanner& scanner, std::vector<PropPlace>& places) {
  if (!scanner.BeginArray()) return false;
  JsonScanner::Cursor items;
  while (scanner.NextItem(items)) {
    if (!scanner.BeginObject()) return false;
    PropPlace& place = places.emplace_back();
    JsonScanner::Cursor members;
    std::string name;
    while (scanner.NextMember(members, name)) {
      const bool read = name == "rotation"      ? ReadNumbers(scanner, place.rotation)
                        : name == "translation" ? ReadNumbers(scanner, place.translation)
                                                : scanner.SkipValue();
      if (!read) return false;
    }
  }
  return !scanner.failed();
}

struct Line {
  int64_t frame = 0;
  std::vector<PropPlace> places;
};

std::optional<Line> Parse(absl::string_view text) {
  JsonScanner scanner(text);
  JsonScanner::Cursor cursor;
  if (scanner.Peek() != JsonScanner::Kind::kObject || !scanner.BeginObject()) return std::nullopt;
  Line line;
  std::optional<double> frame;
  std::string name;
  while (scanner.NextMember(cursor, name)) {
    const bool read = name == "frame"       ? ReadNumber(scanner, frame.emplace())
                      : name == "colliders" ? ReadPlaces(scanner, line.places)
                                            : scanner.SkipValue();
    if (!read) return std::nullopt;
  }
  if (scanner.failed() || !frame.has_value() || !(*frame >= 0 && *frame < 1e15))
    return std::nullopt;
  line.frame = static_cast<int64_t>(*frame);
  return line;
}

}  // namespace

std::vector<std::map<int64_t, PropPlace>> ColliderPlacesOfReports(absl::string_view report_lines) {
  std::vector<std::map<int64_t, PropPlace>> places;
  for (const absl::string_view text : absl::StrSplit(report_lines, '\n', absl::SkipEmpty())) {
    const std::optional<Line> line = Parse(text);
    if (!line.has_value()) continue;
    if (line->places.size() > places.size()) places.resize(line->places.size());
    for (size_t i = 0; i < line->places.size(); ++i) places[i][line->frame] = line->places[i];
  }
  return places;
}

std::vector<Prop> PropsOfRun(const Scene& scene, absl::string_view report_lines) {
  const auto places = ColliderPlacesOfReports(report_lines);
  std::vector<Prop> props;
  for (size_t i = 0; i < scene.colliders.size(); ++i) {
    std::optional<Prop> prop = PropOf(scene.colliders[i].shape);
    if (!prop.has_value()) continue;
    if (i < places.size()) prop->places = places[i];
    props.push_back(*std::move(prop));
  }
  return props;
}

}  // namespace cleave

#include "tests/scenes/scene_json.h"

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "core/base/status.h"

namespace cleave {
namespace {

std::string Quoted(const std::string& text) {
  google::protobuf::Value value;
  value.set_string_value(text);
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(value, &json);
  return status.ok() ? json : "\"\"";
}

std::string Number(double value) {
  return std::isfinite(value) ? absl::StrFormat("%.9g", value) : "null";
}

template <typename Range, typename Write>
std::string List(const Range& range, const Write& write) {
  return absl::StrCat(
      "[",
      absl::StrJoin(range, ",",
                    [&](std::string* out, const auto& each) { absl::StrAppend(out, write(each)); }),
      "]");
}

absl::string_view Truth(bool value) { return value ? "true" : "false"; }

std::string CriterionJson(const Criterion& criterion) {
  const auto condition = [](const Condition& each) {
    return absl::StrCat("{\"text\":", Quoted(each.text), ",\"bound\":", Quoted(each.Bound()), "}");
  };
  return absl::StrCat(
      "{\"text\":", Quoted(criterion.text), ",\"control\":", Truth(criterion.control),
      ",\"full_size\":", Truth(criterion.full_size), ",\"share\":", Number(criterion.share),
      ",\"variants\":", List(criterion.variants, Quoted),
      ",\"conditions\":", List(criterion.conditions, condition), "}");
}

// A finding over those of the trials that have what it is about.
std::string FindingJson(const Criterion& criterion, std::span<const Trial> trials) {
  std::vector<Trial> whole;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(whole), [&](const Trial& trial) {
    return std::all_of(criterion.variants.begin(), criterion.variants.end(),
                       [&](const std::string& each) { return trial.variants.contains(each); });
  });
  const Finding finding = Judge(criterion, whole);
  std::vector<std::string> conditions;
  for (size_t i = 0; i < criterion.conditions.size(); ++i) {
    const Condition& condition = criterion.conditions[i];
    conditions.push_back(absl::StrCat("{\"text\":", Quoted(condition.text),
                                      ",\"bound\":", Quoted(condition.Bound()),
                                      ",\"values\":", List(finding.values[i], Number), "}"));
  }
  const bool asked = !criterion.full_size || trials.front().setting.coarseness <= 1;
  return absl::StrCat("{\"text\":", Quoted(criterion.text),
                      ",\"control\":", Truth(criterion.control), ",\"asked\":", Truth(asked),
                      ",\"holds\":", Truth(finding.holds), ",\"met\":", finding.met,
                      ",\"unmeasured\":", finding.unmeasured, ",\"trials\":", whole.size(),
                      ",\"needed\":", TrialsNeeded(criterion, static_cast<int>(whole.size())),
                      ",\"conditions\":[", absl::StrJoin(conditions, ","), "]}");
}

bool SameGroup(const Setting& a, const Setting& b) {
  return a.layout == b.layout && a.coarseness == b.coarseness;
}

absl::Status AddLine(const DemonstrationKind& kind, absl::string_view line,
                     std::vector<Trial>& trials) {
  google::protobuf::Struct parsed;
  if (!google::protobuf::util::JsonStringToMessage(std::string(line), &parsed).ok())
    return absl::InvalidArgumentError("is no JSON object");
  const auto& members = parsed.fields();
  for (const char* name : {"scene", "variant", "seed", "layout", "coarseness"}) {
    if (!members.contains(name)) return absl::InvalidArgumentError(absl::StrCat("has no ", name));
  }
  if (members.at("scene").string_value() != kind.name)
    return absl::InvalidArgumentError(absl::StrCat("is not of ", kind.name));
  Setting setting;
  setting.seed = static_cast<uint32_t>(members.at("seed").number_value());
  setting.coarseness = members.at("coarseness").number_value();
  const std::string& layout = members.at("layout").string_value();
  setting.layout = layout == LayoutName(MeshLayout::kJitteredLattice) ? MeshLayout::kJitteredLattice
                                                                      : MeshLayout::kUnstructured;
  if (layout != LayoutName(setting.layout))
    return absl::InvalidArgumentError(absl::StrCat("has a layout \"", layout, "\""));
  Metrics metrics;
  for (const auto& [name, value] : members) {
    if (value.kind_case() == google::protobuf::Value::kNumberValue)
      metrics[name] = value.number_value();
  }
  const auto same = [&](const Trial& trial) {
    return trial.setting.seed == setting.seed && SameGroup(trial.setting, setting);
  };
  auto trial = std::find_if(trials.begin(), trials.end(), same);
  if (trial == trials.end()) trial = trials.insert(trials.end(), Trial{setting, {}});
  trial->variants[members.at("variant").string_value()] = std::move(metrics);
  return absl::OkStatus();
}

}  // namespace

absl::string_view LayoutName(MeshLayout layout) {
  return layout == MeshLayout::kJitteredLattice ? "lattice" : "unstructured";
}

std::string RunJson(const std::string& name, const Setting& setting, const Metrics& metrics) {
  std::string line = absl::StrFormat(
      R"({"scene":"%s","variant":"%s","seed":%u,"layout":"%s","coarseness":%s)", name,
      setting.variant, setting.seed, LayoutName(setting.layout), Number(setting.coarseness));
  for (const auto& [metric, value] : metrics)
    absl::StrAppend(&line, ",\"", metric, "\":", Number(value));
  absl::StrAppend(&line, "}");
  return line;
}

std::string KindsJson() {
  return absl::StrCat("{\"scenes\":",
                      List(DemonstrationKinds(),
                           [](const DemonstrationKind& kind) {
                             return absl::StrCat(
                                 "{\"name\":", Quoted(kind.name), ",\"title\":", Quoted(kind.title),
                                 ",\"paper\":", Quoted(kind.paper),
                                 ",\"variants\":", List(kind.variants, Quoted),
                                 ",\"pictured\":", List(kind.pictured, Quoted),
                                 ",\"coarsest\":", Number(kind.coarsest),
                                 ",\"criteria\":", List(kind.criteria, CriterionJson), "}");
                           }),
                      "}");
}

absl::StatusOr<std::vector<Trial>> ReadTrials(const DemonstrationKind& kind,
                                              absl::string_view lines) {
  std::vector<Trial> trials;
  int number = 0;
  for (const absl::string_view line : absl::StrSplit(lines, '\n')) {
    ++number;
    if (line.empty()) continue;
    if (absl::Status added = AddLine(kind, line, trials); !added.ok()) {
      return absl::InvalidArgumentError(absl::StrCat("line ", number, " ", added.message()));
    }
  }
  return trials;
}

std::string FindingsJson(const DemonstrationKind& kind, const std::vector<Trial>& trials) {
  std::vector<std::string> groups;
  std::vector<Setting> seen;
  for (const Trial& first : trials) {
    if (std::any_of(seen.begin(), seen.end(),
                    [&](const Setting& each) { return SameGroup(each, first.setting); }))
      continue;
    seen.push_back(first.setting);
    std::vector<Trial> group;
    for (const Trial& trial : trials) {
      if (SameGroup(trial.setting, first.setting)) group.push_back(trial);
    }
    groups.push_back(absl::StrCat(
        "{\"layout\":\"", LayoutName(first.setting.layout),
        "\",\"coarseness\":", Number(first.setting.coarseness), ",\"seeds\":",
        List(group, [](const Trial& trial) { return absl::StrCat(trial.setting.seed); }),
        ",\"findings\":",
        List(kind.criteria,
             [&](const Criterion& criterion) { return FindingJson(criterion, group); }),
        "}"));
  }
  return absl::StrCat("{\"scene\":", Quoted(kind.name), ",\"groups\":[", absl::StrJoin(groups, ","),
                      "]}");
}

}  // namespace cleave

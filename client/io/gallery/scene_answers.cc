// Reads what the scene runner answers.

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "client/io/gallery/gallery.h"
#include "core/base/status.h"

namespace cleave {
namespace {

using google::protobuf::Struct;
using google::protobuf::Value;

absl::Status Missing(absl::string_view member) {
  return absl::InvalidArgumentError(
      absl::StrCat("the scene runner's answer has no fitting \"", member, "\""));
}

absl::StatusOr<Struct> Parse(const std::string& json) {
  Struct parsed;
  if (!google::protobuf::util::JsonStringToMessage(json, &parsed).ok())
    return absl::InvalidArgumentError("the scene runner's answer is no JSON object");
  return parsed;
}

absl::StatusOr<const Value*> Member(const Struct& object, const std::string& name,
                                    Value::KindCase kind) {
  const auto found = object.fields().find(name);
  if (found == object.fields().end() || found->second.kind_case() != kind) return Missing(name);
  return &found->second;
}

absl::Status Read(const Struct& object, const std::string& name, std::string& text) {
  CLEAVE_ASSIGN_OR_RETURN(const Value* value, Member(object, name, Value::kStringValue));
  text = value->string_value();
  return absl::OkStatus();
}

absl::Status Read(const Struct& object, const std::string& name, bool& truth) {
  CLEAVE_ASSIGN_OR_RETURN(const Value* value, Member(object, name, Value::kBoolValue));
  truth = value->bool_value();
  return absl::OkStatus();
}

absl::Status Read(const Struct& object, const std::string& name, int64_t& number) {
  CLEAVE_ASSIGN_OR_RETURN(const Value* value, Member(object, name, Value::kNumberValue));
  number = static_cast<int64_t>(value->number_value());
  return absl::OkStatus();
}

absl::Status Read(const Struct& object, const std::string& name, std::vector<std::string>& texts) {
  CLEAVE_ASSIGN_OR_RETURN(const Value* value, Member(object, name, Value::kListValue));
  for (const Value& each : value->list_value().values()) {
    if (each.kind_case() != Value::kStringValue) return Missing(name);
    texts.push_back(each.string_value());
  }
  return absl::OkStatus();
}

// Several members, each after its name.
template <typename Into, typename... More>
absl::Status ReadAll(const Struct& object, const std::string& name, Into& into, More&&... more) {
  CLEAVE_RETURN_IF_ERROR(Read(object, name, into));
  if constexpr (sizeof...(more) > 0) return ReadAll(object, std::forward<More>(more)...);
  return absl::OkStatus();
}

// Calls `read` with every object of a list.
template <typename ReadObject>
absl::Status ForEach(const Struct& object, const std::string& name, const ReadObject& read) {
  CLEAVE_ASSIGN_OR_RETURN(const Value* value, Member(object, name, Value::kListValue));
  for (const Value& each : value->list_value().values()) {
    if (each.kind_case() != Value::kStructValue) return Missing(name);
    CLEAVE_RETURN_IF_ERROR(read(each.struct_value()));
  }
  return absl::OkStatus();
}

absl::Status ReadScene(const Struct& object, GalleryScene& scene) {
  CLEAVE_RETURN_IF_ERROR(ReadAll(object, "name", scene.name, "title", scene.title, "paper",
                                 scene.paper, "pictured", scene.pictured));
  CLEAVE_ASSIGN_OR_RETURN(const Value* coarsest, Member(object, "coarsest", Value::kNumberValue));
  scene.coarsest = coarsest->number_value();
  const auto add = [](const std::string& variant, std::vector<std::string>& variants) {
    if (std::find(variants.begin(), variants.end(), variant) == variants.end())
      variants.push_back(variant);
  };
  std::vector<std::string> shown;  // variants that some criterion but a control is about
  const auto read = [&](const Struct& criterion) {
    bool control = false;
    std::vector<std::string> variants;
    CLEAVE_RETURN_IF_ERROR(ReadAll(criterion, "control", control, "variants", variants));
    for (const std::string& variant : variants) {
      add(variant, scene.variants);
      if (!control) add(variant, shown);
    }
    return absl::OkStatus();
  };
  CLEAVE_RETURN_IF_ERROR(ForEach(object, "criteria", read));
  for (const std::string& variant : scene.variants) {
    if (std::find(shown.begin(), shown.end(), variant) == shown.end())
      scene.controls.push_back(variant);
  }
  return absl::OkStatus();
}

absl::Status ReadCondition(const Struct& object, GalleryCondition& condition) {
  CLEAVE_RETURN_IF_ERROR(ReadAll(object, "text", condition.text, "bound", condition.bound));
  CLEAVE_ASSIGN_OR_RETURN(const Value* values, Member(object, "values", Value::kListValue));
  for (const Value& each : values->list_value().values()) {
    condition.values.push_back(each.kind_case() == Value::kNumberValue
                                   ? each.number_value()
                                   : std::numeric_limits<double>::quiet_NaN());
  }
  return absl::OkStatus();
}

absl::Status ReadFinding(const Struct& object, GalleryFinding& finding) {
  CLEAVE_RETURN_IF_ERROR(ReadAll(object, "text", finding.text, "control", finding.control, "asked",
                                 finding.asked, "holds", finding.holds, "met", finding.met,
                                 "unmeasured", finding.unmeasured, "trials", finding.trials,
                                 "needed", finding.needed));
  return ForEach(object, "conditions", [&](const Struct& condition) {
    return ReadCondition(condition, finding.conditions.emplace_back());
  });
}

absl::Status ReadGroup(const Struct& object, GalleryGroup& group) {
  CLEAVE_RETURN_IF_ERROR(Read(object, "layout", group.layout));
  CLEAVE_ASSIGN_OR_RETURN(const Value* coarseness,
                          Member(object, "coarseness", Value::kNumberValue));
  group.coarseness = coarseness->number_value();
  CLEAVE_ASSIGN_OR_RETURN(const Value* seeds, Member(object, "seeds", Value::kListValue));
  for (const Value& seed : seeds->list_value().values())
    group.seeds.push_back(static_cast<int64_t>(seed.number_value()));
  return ForEach(object, "findings", [&](const Struct& finding) {
    return ReadFinding(finding, group.findings.emplace_back());
  });
}

}  // namespace

absl::StatusOr<std::vector<GalleryScene>> ParseSceneList(const std::string& json) {
  CLEAVE_ASSIGN_OR_RETURN(const Struct answer, Parse(json));
  std::vector<GalleryScene> scenes;
  CLEAVE_RETURN_IF_ERROR(ForEach(answer, "scenes", [&](const Struct& scene) {
    return ReadScene(scene, scenes.emplace_back());
  }));
  return scenes;
}

absl::StatusOr<std::vector<GalleryGroup>> ParseFindings(const std::string& json) {
  CLEAVE_ASSIGN_OR_RETURN(const Struct answer, Parse(json));
  std::vector<GalleryGroup> groups;
  CLEAVE_RETURN_IF_ERROR(ForEach(answer, "groups", [&](const Struct& group) {
    return ReadGroup(group, groups.emplace_back());
  }));
  return groups;
}

}  // namespace cleave

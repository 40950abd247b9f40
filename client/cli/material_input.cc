#include "client/cli/material_input.h"

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/io/scene/field_names.h"
#include "core/base/status.h"
#include "core/scene/presets.h"

namespace cleave {
namespace {

constexpr const char* kFileEndings[] = {".json", ".textproto", ".txtpb", ".pbtxt"};

bool EndsLikeAFile(absl::string_view text, absl::string_view before) {
  for (const char* ending : kFileEndings)
    if (absl::EndsWith(text, absl::StrCat(before, ending))) return true;
  return false;
}

absl::StatusOr<MaterialInput> PresetNamed(const std::string& name) {
  MaterialInput input;
  input.name = name;
  input.material.set_preset(name);
  if (FindMaterialPreset(name).has_value()) return input;
  std::vector<std::string> names;
  for (const MaterialPreset& preset : MaterialPresets()) names.push_back(preset.material.name);
  const std::string nearest = NearestName(name, names);
  return absl::InvalidArgumentError(
      absl::StrCat("\"", name, "\" is neither a preset nor the name of a scene or material file",
                   nearest.empty() ? absl::StrCat("; presets: ", absl::StrJoin(names, ", "))
                                   : absl::StrCat("; did you mean \"", nearest, "\"?")));
}

std::string TitleOf(const v1::Material& material, int index) {
  if (!material.name().empty()) return material.name();
  if (!material.preset().empty()) return material.preset();
  return absl::StrCat("materials[", index, "]");
}

absl::StatusOr<MaterialInput> MaterialOfScene(const std::string& path, const std::string& which) {
  CLEAVE_ASSIGN_OR_RETURN(SceneFile file, ReadSceneFile(path));
  const auto& materials = file.scene.materials();
  std::vector<std::string> names;
  int chosen = which.empty() && materials.size() == 1 ? 0 : -1;
  for (int i = 0; i < materials.size(); ++i) {
    names.push_back(absl::StrCat(i, ": ", TitleOf(materials[i], i)));
    if (chosen < 0 && !which.empty() && TitleOf(materials[i], i) == which) chosen = i;
  }
  if (int index = 0;
      chosen < 0 && absl::SimpleAtoi(which, &index) && index >= 0 && index < materials.size()) {
    chosen = index;
  }
  if (chosen < 0) {
    const std::string list = names.empty() ? "the scene has no materials"
                                           : absl::StrCat("it has ", absl::StrJoin(names, ", "));
    return absl::InvalidArgumentError(
        which.empty() ? absl::StrCat(path, ": choose one by --material; ", list)
                      : absl::StrCat(path, ": has no material \"", which, "\"; ", list));
  }
  MaterialInput input;
  input.material = materials[chosen];
  input.stress = file.scene.fracture().stress();
  input.name = TitleOf(input.material, chosen);
  input.field = absl::StrCat("materials[", chosen, "]");
  input.file = std::move(file);
  return input;
}

}  // namespace

absl::Status MaterialInput::Describe(const std::vector<Fault>& faults) const {
  std::vector<std::string> lines;
  for (const Fault& fault : faults) {
    absl::string_view rest = fault.field;
    if (!file.has_value() || !absl::ConsumePrefix(&rest, "material.")) {
      lines.push_back(absl::StrCat(fault.field, ": ", fault.description));
      continue;
    }
    const std::string place = field.empty() ? std::string(rest) : absl::StrCat(field, ".", rest);
    lines.push_back(file->Describe({{place, fault.description}}));
  }
  return absl::InvalidArgumentError(absl::StrJoin(lines, "\n"));
}

absl::StatusOr<MaterialInput> LoadMaterial(const std::string& text, const std::string& which) {
  if (EndsLikeAFile(text, ".material")) {
    CLEAVE_ASSIGN_OR_RETURN(MaterialFile file, ReadMaterialFile(text));
    MaterialInput input;
    input.material = file.material;
    input.name = file.material.name().empty() ? text : file.material.name();
    input.file = std::move(file);
    return input;
  }
  if (EndsLikeAFile(text, "")) return MaterialOfScene(text, which);
  return PresetNamed(text);
}

}  // namespace cleave

#include "core/scene/presets.h"

#include <algorithm>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/scene/limits.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

// What `family` does not say it takes from `preset`.
void Complete(const v1::FibreFamily& preset, v1::FibreFamily& family) {
  v1::FibreFamily whole = preset;
  if (family.direction_case() != v1::FibreFamily::DIRECTION_NOT_SET) whole.clear_direction();
  whole.MergeFrom(family);
  family = whole;
}

}  // namespace

void ResolvePreset(const std::string& field, v1::Material& material, Faults& faults) {
  if (material.preset().empty()) return;
  const std::optional<MaterialPreset> preset = FindMaterialPreset(material.preset());
  if (!preset.has_value()) {
    const std::string name = material.preset().substr(0, limits::kMaxNameBytes);
    material.clear_preset();  // reported once, however often this is called
    faults.Error(field + ".preset",
                 absl::StrCat("\"", name, "\" is not a preset; there are ",
                              absl::StrJoin(MaterialPresets(), ", ",
                                            [](std::string* out, const MaterialPreset& known) {
                                              absl::StrAppend(out, known.material.name);
                                            })));
    return;
  }
  v1::Material whole = MessageFromMaterial(preset->material);
  if (!material.fibres().empty()) {
    for (int k = 0; k < std::min(material.fibres_size(), whole.fibres_size()); ++k)
      Complete(whole.fibres(k), *material.mutable_fibres(k));
    whole.clear_fibres();
  }
  whole.MergeFrom(material);
  whole.clear_preset();
  material = whole;
}

void ResolvePresets(v1::Scene& scene, Faults& faults) {
  for (int i = 0; i < scene.materials_size(); ++i)
    ResolvePreset(absl::StrCat("materials[", i, "]"), *scene.mutable_materials(i), faults);
}

}  // namespace cleave

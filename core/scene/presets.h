#ifndef CLEAVE_CORE_SCENE_PRESETS_H_
#define CLEAVE_CORE_SCENE_PRESETS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "core/scene/scene.h"

namespace cleave {

// A material that many scenes want, with where its numbers come from. Its name is that of the
// material; fibres run along x.
struct MaterialPreset {
  Material material;
  std::string description;           // what it stands for
  std::vector<std::string> sources;  // which number is from where, and what was derived or adapted
};

// All presets, by kind. Each passes the rules of a scene without a warning.
std::vector<MaterialPreset> MaterialPresets();

// nullopt: no preset has this name.
std::optional<MaterialPreset> FindMaterialPreset(absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_PRESETS_H_

#ifndef CLEAVE_CLIENT_CLI_MATERIAL_INPUT_H_
#define CLEAVE_CLIENT_CLI_MATERIAL_INPUT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/v1/scene.pb.h"
#include "client/io/scene/scene_file.h"
#include "core/base/faults.h"

namespace cleave {

// A material as the command line names it.
struct MaterialInput {
  v1::Material material;
  v1::FractureStress stress = v1::FRACTURE_STRESS_UNSPECIFIED;  // of the scene
  std::string name;                                             // for people
  std::optional<FileLines> file;                                // where it was read
  std::string field;  // its path there; empty: the file is the material

  // InvalidArgument with the faults of a probe of it, one a line; those of the material with their
  // lines in the file.
  absl::Status Describe(const std::vector<Fault>& faults) const;
};

// `text` is the name of a preset, a material file (*.material.json, *.material.textproto) or a
// scene file, of which `which` chooses a material by name or index; it may be empty where there is
// one only. Errors: those of the files; InvalidArgument for names that there are not.
absl::StatusOr<MaterialInput> LoadMaterial(const std::string& text, const std::string& which);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_MATERIAL_INPUT_H_

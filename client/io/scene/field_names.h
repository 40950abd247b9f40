#ifndef CLEAVE_CLIENT_IO_SCENE_FIELD_NAMES_H_
#define CLEAVE_CLIENT_IO_SCENE_FIELD_NAMES_H_

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace cleave {

// The candidate that `name` is most likely a misspelling of, or empty when none is near. Case does
// not count; a candidate that ends in "_" + name is nearest (X for AXIS_X).
std::string NearestName(absl::string_view name, const std::vector<std::string>& candidates);

// `material field "youngs_moduls" is unknown; did you mean "youngs_modulus"?`, or the list of the
// fields that there are when none is near.
std::string UnknownFieldText(const google::protobuf::Descriptor& message, absl::string_view name);

// `"LATICE" is unknown; did you mean "MESH_LAYOUT_JITTERED_LATTICE"?`, or all values.
std::string UnknownValueText(const google::protobuf::EnumDescriptor& type, absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SCENE_FIELD_NAMES_H_

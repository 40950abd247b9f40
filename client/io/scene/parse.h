#ifndef CLEAVE_CLIENT_IO_SCENE_PARSE_H_
#define CLEAVE_CLIENT_IO_SCENE_PARSE_H_

#include <google/protobuf/message.h>

#include <map>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace cleave {

// Something wrong with a scene file. Beyond kMaxSceneFaults the rest are not kept.
struct SceneFault {
  int line = 0;
  std::string text;
};
inline constexpr size_t kMaxSceneFaults = 100;

// Lines are kept for this many fields; a fault beyond them is shown with an enclosing field's line.
inline constexpr size_t kMaxSceneLines = 100'000;

// Both fill `message` (the fields that are right) and `lines` (by field path), and return all
// faults.
std::vector<SceneFault> ParseJsonMessage(absl::string_view text, google::protobuf::Message& message,
                                         std::map<std::string, int>& lines);
std::vector<SceneFault> ParseTextMessage(absl::string_view text, google::protobuf::Message& message,
                                         std::map<std::string, int>& lines);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SCENE_PARSE_H_

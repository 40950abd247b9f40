#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/io/scene/field_names.h"
#include "client/io/scene/parse.h"
#include "client/io/scene/utf8.h"

namespace cleave {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using google::protobuf::TextFormat;

constexpr int kMaxDepth = 100;

class FaultCollector : public google::protobuf::io::ErrorCollector {
 public:
  explicit FaultCollector(const Message& root) : root_(root) {}

  void AddError(int line, int /*column*/, const std::string& message) override {
    Add(line, message);
  }
  // Unknown fields come as warnings, since the parser is told to go on after them.
  void AddWarning(int line, int /*column*/, const std::string& message) override {
    Add(line, message);
  }
  std::vector<SceneFault> Take() { return std::move(faults_); }

 private:
  void Add(int line, const std::string& message) {
    if (faults_.size() >= kMaxSceneFaults) return;
    // Message type "cleave.v1.Material" has no field named "youngs_moduls".
    const std::vector<std::string> parts = absl::StrSplit(message, '"');
    std::string text = message;
    if (parts.size() == 5 && parts[0] == "Message type " && parts[2] == " has no field named ") {
      const auto* type = root_.GetDescriptor()->file()->pool()->FindMessageTypeByName(parts[1]);
      if (type != nullptr) text = UnknownFieldText(*type, parts[3]);
    }
    faults_.push_back({std::max(line, 0) + 1, std::move(text)});
  }

  const Message& root_;
  std::vector<SceneFault> faults_;
};

// Whether brackets nest deeper than kMaxDepth outside strings and comments: the parser skips
// unknown fields by recursion without a limit of its own.
int LineOfTooDeep(absl::string_view text) {
  int depth = 0, line = 1;
  for (size_t i = 0; i < text.size(); ++i) {
    const char next = text[i];
    if (next == '\n') ++line;
    if (next == '#') {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
    } else if (next == '"' || next == '\'') {
      for (++i; i < text.size() && text[i] != next && text[i] != '\n'; ++i)
        if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] != '\n') ++i;
      if (i < text.size() && text[i] == '\n') ++line;
    } else if (next == '{' || next == '<' || next == '[') {
      if (++depth > kMaxDepth) return line;
    } else if (next == '}' || next == '>' || next == ']') {
      --depth;
    }
  }
  return 0;
}

// Notes the lines of all fields, and finds the values that the text format allows and a scene does
// not: infinities, NaN, strings that are not UTF-8.
class FieldWalk {
 public:
  FieldWalk(std::map<std::string, int>& lines, std::vector<SceneFault>& faults)
      : lines_(lines), faults_(faults) {}

  void Walk(const Message& message, const TextFormat::ParseInfoTree* tree,
            const std::string& path) {
    std::vector<const FieldDescriptor*> fields;
    const Reflection& reflection = *message.GetReflection();
    reflection.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
      const std::string field_path =
          path.empty() ? field->name() : absl::StrCat(path, ".", field->name());
      const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
      for (int i = 0; i < count; ++i) {
        const int index = field->is_repeated() ? i : -1;
        const int line =
            tree == nullptr ? 0 : std::max(tree->GetLocation(field, index).line, -1) + 1;
        const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
        const std::string item_path =
            field->is_repeated() ? absl::StrCat(field_path, "[", i, "]") : field_path;
        if (i == 0) Note(field_path, line);
        if (is_message) {
          Note(item_path, line);
          Walk(index < 0 ? reflection.GetMessage(message, field)
                         : reflection.GetRepeatedMessage(message, field, i),
               tree == nullptr ? nullptr : tree->GetTreeForNested(field, index), item_path);
        } else {
          CheckValue(message, *field, index, item_path, line);
        }
      }
    }
  }

 private:
  void Note(const std::string& path, int line) {
    if (lines_.size() < kMaxSceneLines) lines_.emplace(path, line);
  }
  void Report(int line, std::string text) {
    if (faults_.size() >= kMaxSceneFaults) return;
    SceneFault& fault = faults_.emplace_back();
    fault.line = line;
    fault.text = std::move(text);
  }
  void CheckValue(const Message& message, const FieldDescriptor& field, int index,
                  const std::string& path, int line) {
    const Reflection& reflection = *message.GetReflection();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      const double value = index < 0 ? reflection.GetDouble(message, &field)
                                     : reflection.GetRepeatedDouble(message, &field, index);
      if (std::isnan(value)) Report(line, absl::StrCat(path, ": ", value, " is not a number"));
    } else if (field.type() == FieldDescriptor::TYPE_STRING) {
      const std::string value = index < 0 ? reflection.GetString(message, &field)
                                          : reflection.GetRepeatedString(message, &field, index);
      if (LineOfInvalidUtf8(value) > 0) Report(line, absl::StrCat(path, ": is not UTF-8 text"));
    }
  }

  std::map<std::string, int>& lines_;
  std::vector<SceneFault>& faults_;
};

}  // namespace

std::vector<SceneFault> ParseTextMessage(absl::string_view text, Message& message,
                                         std::map<std::string, int>& lines) {
  if (const int line = LineOfTooDeep(text); line > 0)
    return {{line, absl::StrCat("nested deeper than ", kMaxDepth, " levels")}};
  FaultCollector collector(message);
  TextFormat::ParseInfoTree tree;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&collector);
  parser.WriteLocationsTo(&tree);
  parser.AllowUnknownField(true);
  parser.SetRecursionLimit(kMaxDepth);
  google::protobuf::io::ArrayInputStream input(text.data(), static_cast<int>(text.size()));
  const bool parsed = parser.Parse(&input, &message);
  std::vector<SceneFault> faults = collector.Take();
  if (!parsed && faults.empty()) faults.push_back({1, "is not in protobuf text format"});
  FieldWalk(lines, faults).Walk(message, &tree, "");
  return faults;
}

}  // namespace cleave

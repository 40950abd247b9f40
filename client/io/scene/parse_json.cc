#include <google/protobuf/descriptor.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/io/scene/field_names.h"
#include "client/io/scene/json_scanner.h"
#include "client/io/scene/parse.h"

namespace cleave {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumValueDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using Kind = JsonScanner::Kind;

const FieldDescriptor* FindField(const Descriptor& type, const std::string& name) {
  if (const FieldDescriptor* field = type.FindFieldByName(name)) return field;
  return type.FindFieldByCamelcaseName(name);
}

std::string Quoted(absl::string_view text) {
  constexpr size_t kShown = 60;
  return absl::StrCat("\"", text.substr(0, kShown), text.size() > kShown ? "..." : "", "\"");
}

// Fills a message from JSON front to back. Faults of fields do not stop it; faults of syntax do.
class JsonReader {
 public:
  JsonReader(absl::string_view text, std::map<std::string, int>& lines)
      : scanner_(text), lines_(lines) {}

  std::vector<SceneFault> Read(Message& message) {
    if (scanner_.Peek() != Kind::kObject && !scanner_.failed())
      Report("a scene is one JSON object: { ... }");
    else if (ReadMessage(message, ""))
      scanner_.ReadEnd();
    if (scanner_.failed()) AddFault(scanner_.error());
    return std::move(faults_);
  }

 private:
  void Report(std::string text) {
    if (faults_.size() < kMaxSceneFaults) AddFault(std::move(text));
  }
  void AddFault(std::string text) {
    SceneFault& fault = faults_.emplace_back();
    fault.line = scanner_.line();
    fault.text = std::move(text);
  }
  void Note(const std::string& path) {
    if (lines_.size() < kMaxSceneLines) lines_.emplace(path, scanner_.line());
  }

  // Says that a value does not fit, and steps over it.
  bool Refuse(const std::string& path, absl::string_view wanted) {
    std::string text;
    switch (scanner_.Peek()) {
      case Kind::kString:
        if (!scanner_.ReadString(text)) return false;
        Report(absl::StrCat(path, ": ", Quoted(text), " is not ", wanted));
        return true;
      case Kind::kNumber: {
        absl::string_view digits;
        if (!scanner_.ReadNumber(digits)) return false;
        Report(absl::StrCat(path, ": ", digits.substr(0, 60), " is not ", wanted));
        return true;
      }
      case Kind::kObject:
        Report(absl::StrCat(path, ": an object { } is not ", wanted));
        break;
      case Kind::kArray:
        Report(absl::StrCat(path, ": a list [ ] is not ", wanted));
        break;
      case Kind::kBool:
        Report(absl::StrCat(path, ": true or false is not ", wanted));
        break;
      case Kind::kNull:
        Report(absl::StrCat(path, ": null is not ", wanted));
        break;
      case Kind::kError:
        return false;
    }
    return scanner_.SkipValue();
  }

  bool ReadMessage(Message& message, const std::string& path) {
    if (!scanner_.BeginObject()) return false;
    const Descriptor& type = *message.GetDescriptor();
    JsonScanner::Cursor cursor;
    std::set<const FieldDescriptor*> seen;
    std::string name;
    while (scanner_.NextMember(cursor, name)) {
      const FieldDescriptor* field = FindField(type, name);
      if (field == nullptr) {
        Report(UnknownFieldText(type, name));
        if (!scanner_.SkipValue()) return false;
        continue;
      }
      const std::string field_path =
          path.empty() ? field->name() : absl::StrCat(path, ".", field->name());
      Note(field_path);
      const bool first = seen.insert(field).second;
      if (scanner_.Peek() == Kind::kNull) {
        if (!scanner_.ReadNull()) return false;
        continue;
      }
      const google::protobuf::OneofDescriptor* choice = field->real_containing_oneof();
      const FieldDescriptor* other =
          choice == nullptr ? nullptr
                            : message.GetReflection()->GetOneofFieldDescriptor(message, choice);
      if (!first) {
        Report(absl::StrCat(field_path, ": is given twice"));
      } else if (other != nullptr) {
        Report(absl::StrCat(field_path, ": excludes \"", other->name(),
                            "\", which is given too; keep one of them"));
      } else {
        if (!ReadField(message, *field, field_path)) return false;
        continue;
      }
      if (!scanner_.SkipValue()) return false;
    }
    return !scanner_.failed();
  }

  bool ReadField(Message& message, const FieldDescriptor& field, const std::string& path) {
    if (!field.is_repeated()) return ReadValue(message, field, path);
    if (scanner_.Peek() != Kind::kArray) return Refuse(path, "a list [ ]");
    if (!scanner_.BeginArray()) return false;
    JsonScanner::Cursor cursor;
    for (int index = 0; scanner_.NextItem(cursor); ++index)
      if (!ReadValue(message, field, absl::StrCat(path, "[", index, "]"))) return false;
    return !scanner_.failed();
  }

  // One value of a singular field, or one item of a repeated one.
  bool ReadValue(Message& message, const FieldDescriptor& field, const std::string& path) {
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE: {
        if (scanner_.Peek() != Kind::kObject) return Refuse(path, "an object { }");
        if (field.is_repeated()) Note(path);
        const Reflection& reflection = *message.GetReflection();
        Message* child = field.is_repeated() ? reflection.AddMessage(&message, &field)
                                             : reflection.MutableMessage(&message, &field);
        return ReadMessage(*child, path);
      }
      case FieldDescriptor::CPPTYPE_STRING: {
        if (scanner_.Peek() != Kind::kString) return Refuse(path, "a string \" \"");
        std::string value;
        if (!scanner_.ReadString(value)) return false;
        if (field.type() == FieldDescriptor::TYPE_BYTES) {
          std::string bytes;
          if (!absl::Base64Unescape(value, &bytes) && !absl::WebSafeBase64Unescape(value, &bytes)) {
            Report(absl::StrCat(path, ": ", Quoted(value), " is not base64"));
            return true;
          }
          value = std::move(bytes);
        }
        return Store(message, field, &Reflection::SetString, &Reflection::AddString,
                     std::move(value));
      }
      case FieldDescriptor::CPPTYPE_BOOL: {
        if (scanner_.Peek() != Kind::kBool) return Refuse(path, "true or false");
        bool value = false;
        if (!scanner_.ReadBool(value)) return false;
        return Store(message, field, &Reflection::SetBool, &Reflection::AddBool, value);
      }
      case FieldDescriptor::CPPTYPE_ENUM:
        return ReadEnum(message, field, path);
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return ReadReal<double>(message, field, path, &Reflection::SetDouble,
                                &Reflection::AddDouble);
      case FieldDescriptor::CPPTYPE_FLOAT:
        return ReadReal<float>(message, field, path, &Reflection::SetFloat, &Reflection::AddFloat);
      case FieldDescriptor::CPPTYPE_INT32:
        return ReadInteger<int32_t>(message, field, path, &Reflection::SetInt32,
                                    &Reflection::AddInt32);
      case FieldDescriptor::CPPTYPE_INT64:
        return ReadInteger<int64_t>(message, field, path, &Reflection::SetInt64,
                                    &Reflection::AddInt64);
      case FieldDescriptor::CPPTYPE_UINT32:
        return ReadInteger<uint32_t>(message, field, path, &Reflection::SetUInt32,
                                     &Reflection::AddUInt32);
      case FieldDescriptor::CPPTYPE_UINT64:
        return ReadInteger<uint64_t>(message, field, path, &Reflection::SetUInt64,
                                     &Reflection::AddUInt64);
    }
    return Refuse(path, "supported here");
  }

  template <typename Set, typename Add, typename Value>
  static bool Store(Message& message, const FieldDescriptor& field, Set set, Add add, Value value) {
    const Reflection& reflection = *message.GetReflection();
    if (field.is_repeated())
      (reflection.*add)(&message, &field, std::move(value));
    else
      (reflection.*set)(&message, &field, std::move(value));
    return true;
  }

  bool ReadEnum(Message& message, const FieldDescriptor& field, const std::string& path) {
    if (scanner_.Peek() != Kind::kString) return Refuse(path, "one of the names, in quotes");
    std::string name;
    if (!scanner_.ReadString(name)) return false;
    const EnumValueDescriptor* value = field.enum_type()->FindValueByName(name);
    if (value == nullptr) {
      Report(absl::StrCat(path, ": ", UnknownValueText(*field.enum_type(), name)));
      return true;
    }
    const Reflection& reflection = *message.GetReflection();
    if (field.is_repeated())
      reflection.AddEnum(&message, &field, value);
    else
      reflection.SetEnum(&message, &field, value);
    return true;
  }

  // JSON has no number for infinity; protobuf's has strings.
  template <typename Real, typename Set, typename Add>
  bool ReadReal(Message& message, const FieldDescriptor& field, const std::string& path, Set set,
                Add add) {
    constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
    if (scanner_.Peek() == Kind::kString) {
      std::string text;
      if (!scanner_.ReadString(text)) return false;
      if (text == "Infinity") return Store(message, field, set, add, kInfinity);
      if (text == "-Infinity") return Store(message, field, set, add, -kInfinity);
      Report(absl::StrCat(path, ": ", Quoted(text), " is not a number",
                          absl::StartsWithIgnoreCase(text, "inf") ? "; write \"Infinity\"" : ""));
      return true;
    }
    if (scanner_.Peek() != Kind::kNumber) return Refuse(path, "a number");
    absl::string_view digits;
    if (!scanner_.ReadNumber(digits)) return false;
    double value = 0;
    if (!absl::SimpleAtod(digits, &value) || !std::isfinite(static_cast<Real>(value))) {
      Report(absl::StrCat(path, ": ", digits.substr(0, 60), " is too large for a number"));
      return true;
    }
    return Store(message, field, set, add, static_cast<Real>(value));
  }

  // Protobuf writes 64-bit integers as strings, and allows any number without a fraction.
  template <typename Integer, typename Set, typename Add>
  bool ReadInteger(Message& message, const FieldDescriptor& field, const std::string& path, Set set,
                   Add add) {
    std::string text;
    if (scanner_.Peek() == Kind::kNumber) {
      absl::string_view digits;
      if (!scanner_.ReadNumber(digits)) return false;
      text = std::string(digits);
    } else if (scanner_.Peek() == Kind::kString) {
      if (!scanner_.ReadString(text)) return false;
    } else {
      return Refuse(path, "a whole number");
    }
    Integer value = 0;
    double real = 0;
    constexpr double kExact = 9007199254740992.0;  // 2^53: beyond it a double skips integers
    if (absl::SimpleAtoi(text, &value)) return Store(message, field, set, add, value);
    if (!absl::SimpleAtod(text, &real) || std::isnan(real) ||
        (std::isfinite(real) && std::floor(real) != real)) {
      Report(absl::StrCat(path, ": ", text.substr(0, 60), " is not a whole number"));
      return true;
    }
    if (real < static_cast<double>(std::numeric_limits<Integer>::min()) ||
        real > static_cast<double>(std::numeric_limits<Integer>::max()) ||
        std::fabs(real) > kExact) {
      Report(absl::StrCat(path, ": ", text.substr(0, 60), " is outside [",
                          std::numeric_limits<Integer>::min(), ", ",
                          std::numeric_limits<Integer>::max(), "]"));
      return true;
    }
    return Store(message, field, set, add, static_cast<Integer>(real));
  }

  JsonScanner scanner_;
  std::map<std::string, int>& lines_;
  std::vector<SceneFault> faults_;
};

}  // namespace

std::vector<SceneFault> ParseJsonMessage(absl::string_view text, Message& message,
                                         std::map<std::string, int>& lines) {
  return JsonReader(text, lines).Read(message);
}

}  // namespace cleave

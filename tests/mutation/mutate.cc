#include "tests/mutation/mutate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace cleave {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

double StrangeDouble(Dice& dice) {
  constexpr std::array<double, 14> kStrange = {0,
                                               -0.0,
                                               1,
                                               -1,
                                               0.5,
                                               1e-300,
                                               1e300,
                                               -1e300,
                                               4.9e-324,
                                               1e-9,
                                               1e9,
                                               1e15,
                                               std::numeric_limits<double>::infinity(),
                                               std::numeric_limits<double>::quiet_NaN()};
  return kStrange[dice.Roll(kStrange.size())];
}

int64_t StrangeInteger(Dice& dice) {
  constexpr std::array<int64_t, 12> kStrange = {0,
                                                1,
                                                -1,
                                                2,
                                                63,
                                                1000,
                                                std::numeric_limits<int32_t>::max(),
                                                std::numeric_limits<int32_t>::min(),
                                                std::numeric_limits<uint32_t>::max(),
                                                std::numeric_limits<int64_t>::max(),
                                                std::numeric_limits<int64_t>::min(),
                                                1'000'000};
  return kStrange[dice.Roll(kStrange.size())];
}

std::string StrangeText(Dice& dice) {
  switch (dice.Roll(6)) {
    case 0:
      return "";
    case 1:
      return std::string(5000, 'x');
    case 2:
      return "../../etc/passwd";
    case 3:
      return std::string("nul\0byte", 8);
    case 4:
      return "sessions/";
    default:
      return "%s%n{}$(id)";
  }
}

void SetStrange(Message& message, const FieldDescriptor* field, Dice& dice) {
  const Reflection* reflection = message.GetReflection();
  const bool list = field->is_repeated();
  switch (field->cpp_type()) {
#define CLEAVE_SET(CPPTYPE, Name, value)                  \
  case FieldDescriptor::CPPTYPE_##CPPTYPE:                \
    list ? reflection->Add##Name(&message, field, value)  \
         : reflection->Set##Name(&message, field, value); \
    break
    CLEAVE_SET(DOUBLE, Double, StrangeDouble(dice));
    CLEAVE_SET(FLOAT, Float, static_cast<float>(StrangeDouble(dice)));
    CLEAVE_SET(INT32, Int32, static_cast<int32_t>(StrangeInteger(dice)));
    CLEAVE_SET(INT64, Int64, StrangeInteger(dice));
    CLEAVE_SET(UINT32, UInt32, static_cast<uint32_t>(StrangeInteger(dice)));
    CLEAVE_SET(UINT64, UInt64, static_cast<uint64_t>(StrangeInteger(dice)));
    CLEAVE_SET(BOOL, Bool, dice.OneIn(2));
    CLEAVE_SET(ENUM, EnumValue, static_cast<int>(dice.Roll(9)) - 2);
    CLEAVE_SET(STRING, String, StrangeText(dice));
#undef CLEAVE_SET
    case FieldDescriptor::CPPTYPE_MESSAGE:
      list ? reflection->AddMessage(&message, field) : reflection->MutableMessage(&message, field);
      break;
  }
}

void MutateList(Message& message, const FieldDescriptor* field, Dice& dice) {
  const Reflection* reflection = message.GetReflection();
  const int size = reflection->FieldSize(message, field);
  switch (dice.Roll(4)) {
    case 0:
      if (size > 0) reflection->RemoveLast(&message, field);
      break;
    case 1:
      reflection->ClearField(&message, field);
      break;
    case 2:
      if (size > 1) {
        reflection->SwapElements(&message, field, 0,
                                 static_cast<int>(dice.Roll(static_cast<uint64_t>(size))));
      }
      break;
    default:
      for (uint64_t more = dice.Roll(4) + 1; more > 0; --more) SetStrange(message, field, dice);
  }
}

void MutateField(Message& message, const FieldDescriptor* field, Dice& dice) {
  if (field->is_repeated()) {
    MutateList(message, field, dice);
  } else if (dice.OneIn(3)) {
    message.GetReflection()->ClearField(&message, field);
  } else {
    SetStrange(message, field, dice);
  }
}

}  // namespace

uint64_t Dice::Roll(uint64_t sides) {
  if (sides == 0) return 0;
  const double draw = UniformDraw(seed_, RandomStream::kMeshJitter, drawn_++, 0);
  return std::min(sides - 1, static_cast<uint64_t>(draw * static_cast<double>(sides)));
}

std::string MutateBytes(absl::string_view bytes, Dice& dice) {
  std::string out(bytes);
  for (uint64_t changes = dice.Roll(6) + 1; changes > 0; --changes) {
    const size_t at = dice.Roll(out.size() + 1);
    switch (dice.Roll(6)) {
      case 0:
        if (at < out.size()) out[at] = static_cast<char>(out[at] ^ (1 << dice.Roll(8)));
        break;
      case 1:
        if (at < out.size()) out[at] = static_cast<char>(dice.Roll(256));
        break;
      case 2:
        out.resize(at);
        break;
      case 3:
        out.insert(at, out.substr(dice.Roll(out.size() + 1), dice.Roll(64)));
        break;
      case 4:
        out.erase(at, dice.Roll(64));
        break;
      default:
        out.insert(at, std::to_string(StrangeInteger(dice)));
    }
  }
  return out;
}

void MutateMessage(Message& message, Dice& dice) {
  for (uint64_t changes = dice.Roll(4) + 1; changes > 0; --changes) {
    // Walk down at random, through fields that are there, and change one field where the walk ends.
    Message* at = &message;
    while (true) {
      const google::protobuf::Descriptor* type = at->GetDescriptor();
      if (type->field_count() == 0) break;
      const Reflection* reflection = at->GetReflection();
      const FieldDescriptor* field =
          type->field(static_cast<int>(dice.Roll(static_cast<uint64_t>(type->field_count()))));
      const bool message_field = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
      if (message_field && field->is_repeated() && reflection->FieldSize(*at, field) > 0 &&
          !dice.OneIn(8)) {
        const int size = reflection->FieldSize(*at, field);
        at = reflection->MutableRepeatedMessage(
            at, field, static_cast<int>(dice.Roll(static_cast<uint64_t>(size))));
      } else if (message_field && !field->is_repeated() && reflection->HasField(*at, field) &&
                 !dice.OneIn(8)) {
        at = reflection->MutableMessage(at, field);
      } else {
        MutateField(*at, field, dice);
        break;
      }
    }
  }
}

}  // namespace cleave

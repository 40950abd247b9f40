#include "client/io/impurity/ply_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// Vertices are numbered in 32 bits.
constexpr int64_t kMaxItems = int64_t{1} << 30;

struct Number {
  size_t bytes = 0;
  bool floating = false;
  bool is_signed = false;
};

absl::StatusOr<Number> NumberOf(absl::string_view type) {
  if (type == "char" || type == "int8") return Number{1, false, true};
  if (type == "uchar" || type == "uint8") return Number{1, false, false};
  if (type == "short" || type == "int16") return Number{2, false, true};
  if (type == "ushort" || type == "uint16") return Number{2, false, false};
  if (type == "int" || type == "int32") return Number{4, false, true};
  if (type == "uint" || type == "uint32") return Number{4, false, false};
  if (type == "float" || type == "float32") return Number{4, true, true};
  if (type == "double" || type == "float64") return Number{8, true, true};
  return absl::InvalidArgumentError(absl::StrCat("\"", type.substr(0, 40), "\" is no type of PLY"));
}

struct Property {
  std::string name;
  Number number;  // of a list: of its items
  Number count;   // of a list; of no bytes for a single number
};

struct Element {
  std::string name;
  int64_t count = 0;
  std::vector<Property> properties;
};

enum class Coding { kText, kLittle, kBig };

struct Header {
  Coding coding = Coding::kText;
  std::vector<Element> elements;
  size_t size = 0;  // bytes
};

absl::StatusOr<Header> ParseHeader(absl::string_view bytes) {
  Header header;
  bool has_format = false;
  for (int line = 1;; ++line) {
    const size_t end = bytes.find('\n', header.size);
    if (end == absl::string_view::npos)
      return absl::InvalidArgumentError("the header has no end_header");
    const std::vector<absl::string_view> words = absl::StrSplit(
        bytes.substr(header.size, end - header.size), absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
    header.size = end + 1;
    const auto wrong = [line](absl::string_view what) {
      return absl::InvalidArgumentError(absl::StrCat("line ", line, ": ", what));
    };
    if (line == 1) {
      if (words.size() != 1 || words[0] != "ply") return wrong("a PLY file begins with \"ply\"");
    } else if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      continue;
    } else if (words[0] == "end_header") {
      if (!has_format) return wrong("the header names no format");
      return header;
    } else if (words[0] == "format" && words.size() == 3) {
      has_format = true;
      if (words[1] == "ascii") {
        header.coding = Coding::kText;
      } else if (words[1] == "binary_little_endian") {
        header.coding = Coding::kLittle;
      } else if (words[1] == "binary_big_endian") {
        header.coding = Coding::kBig;
      } else {
        return wrong("unknown format");
      }
    } else if (words[0] == "element" && words.size() == 3) {
      Element& element = header.elements.emplace_back();
      element.name = std::string(words[1]);
      if (!absl::SimpleAtoi(words[2], &element.count) || element.count < 0 ||
          element.count > kMaxItems)
        return wrong(absl::StrCat("the count is not within [0, ", kMaxItems, "]"));
    } else if (words[0] == "property" && !header.elements.empty() &&
               (words.size() == 3 || (words.size() == 5 && words[1] == "list"))) {
      Property& property = header.elements.back().properties.emplace_back();
      property.name = std::string(words.back());
      CLEAVE_ASSIGN_OR_RETURN(property.number, NumberOf(words[words.size() - 2]));
      if (words.size() == 5) {
        CLEAVE_ASSIGN_OR_RETURN(property.count, NumberOf(words[2]));
      }
    } else {
      return wrong("cannot be understood");
    }
  }
}

// Takes one number after another from what follows the header.
class Numbers {
 public:
  Numbers(absl::string_view bytes, Coding coding) : rest_(bytes), coding_(coding) {}

  bool Next(const Number& number, double& value) {
    if (coding_ != Coding::kText) return NextBinary(number, value);
    const size_t begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == absl::string_view::npos) return false;
    rest_.remove_prefix(begin);
    const size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    const bool right = absl::SimpleAtod(rest_.substr(0, end), &value);
    rest_.remove_prefix(end);
    return right;
  }

 private:
  bool NextBinary(const Number& number, double& value) {
    if (rest_.size() < number.bytes) return false;
    unsigned char raw[8] = {};
    for (size_t k = 0; k < std::min(number.bytes, sizeof raw); ++k)
      raw[k] =
          static_cast<unsigned char>(rest_[coding_ == Coding::kBig ? number.bytes - 1 - k : k]);
    rest_.remove_prefix(number.bytes);
    if (number.floating && number.bytes == 4) {
      float single = 0;
      std::memcpy(&single, raw, 4);
      value = single;
    } else if (number.floating) {
      std::memcpy(&value, raw, 8);
    } else {
      uint32_t word = 0;
      std::memcpy(&word, raw, 4);
      const auto shift = static_cast<int>(32 - 8 * number.bytes);
      value = number.is_signed ? static_cast<double>(static_cast<int32_t>(word << shift) >> shift)
                               : static_cast<double>(word);
    }
    return true;
  }

  absl::string_view rest_;
  const Coding coding_;
};

// Which property of the vertices has the values.
absl::StatusOr<size_t> ValuesOf(const Element& vertices, const std::string& wanted) {
  const std::set<absl::string_view> usual = {"x",  "y",   "z",     "nx",   "ny",
                                             "nz", "red", "green", "blue", "alpha"};
  std::vector<std::string> names;
  std::vector<size_t> own;  // beside the usual ones
  size_t red = vertices.properties.size();
  for (size_t k = 0; k < vertices.properties.size(); ++k) {
    const Property& property = vertices.properties[k];
    if (property.count.bytes > 0) continue;
    names.push_back(property.name);
    if (!wanted.empty() && property.name == wanted) return k;
    if (property.name == "red") red = k;
    if (usual.count(property.name) == 0) own.push_back(k);
  }
  if (wanted.empty() && own.size() == 1) return own[0];
  if (wanted.empty() && own.empty() && red < vertices.properties.size()) return red;
  return absl::InvalidArgumentError(
      absl::StrCat(wanted.empty() ? "no vertex property stands out: name one in `array`"
                                  : absl::StrCat("vertices have no property \"", wanted, "\""),
                   "; they have ", absl::StrJoin(names, ", ")));
}

// Cuts a face into a fan.
absl::Status AddFace(const std::vector<double>& ids, size_t vertices, PlyPoints& points) {
  std::vector<int32_t> corners;
  for (const double id : ids) {
    if (!(id >= 0 && id < static_cast<double>(vertices)) || id != std::floor(id)) {
      return absl::InvalidArgumentError(absl::StrCat("a face names vertex ", id, " of ", vertices));
    }
    corners.push_back(static_cast<int32_t>(id));
  }
  for (size_t k = 2; k < corners.size(); ++k)
    points.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<PlyPoints> ParsePlyPoints(absl::string_view bytes, const std::string& property) {
  CLEAVE_ASSIGN_OR_RETURN(const Header header, ParseHeader(bytes));
  Numbers numbers(bytes.substr(header.size), header.coding);
  PlyPoints points;
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    const bool vertices = element.name == "vertex";
    size_t value_at = element.properties.size();
    if (vertices) {
      has_vertices = true;
      for (const char* axis : {"x", "y", "z"}) {
        if (std::none_of(element.properties.begin(), element.properties.end(),
                         [axis](const Property& each) { return each.name == axis; }))
          return absl::InvalidArgumentError(absl::StrCat("vertices have no ", axis));
      }
      CLEAVE_ASSIGN_OR_RETURN(value_at, ValuesOf(element, property));
    }
    if (element.properties.empty()) continue;
    std::vector<double> list;
    for (int64_t item = 0; item < element.count; ++item) {
      Vec3 place{0, 0, 0};
      double value = 0;
      for (size_t k = 0; k < element.properties.size(); ++k) {
        const Property& each = element.properties[k];
        const auto cut_off = [&] {
          return absl::InvalidArgumentError(
              absl::StrCat(element.name, " ", item, ": ", each.name, " is missing or no number"));
        };
        double number = 0;
        if (each.count.bytes == 0) {
          if (!numbers.Next(each.number, number)) return cut_off();
          if (each.name.size() == 1 && each.name[0] >= 'x' && each.name[0] <= 'z')
            place[static_cast<size_t>(each.name[0] - 'x')] = number;
          if (k == value_at) {
            const bool part = each.number.bytes == 1 && !each.number.is_signed;
            value = part ? number / 255 : number;
          }
          continue;
        }
        double count = 0;
        if (!numbers.Next(each.count, count) || !(count >= 0)) return cut_off();
        list.clear();
        for (double i = 0; i < count; ++i) {
          if (!numbers.Next(each.number, number)) return cut_off();
          list.push_back(number);
        }
        if (element.name == "face" &&
            (each.name == "vertex_indices" || each.name == "vertex_index"))
          CLEAVE_RETURN_IF_ERROR(AddFace(list, points.vertices.size(), points));
      }
      if (!vertices) continue;
      points.vertices.push_back(place);
      points.values.push_back(value);
    }
  }
  if (!has_vertices) return absl::InvalidArgumentError("the file has no vertices");
  return points;
}

}  // namespace cleave

#include "client/io/mesh/medit.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/scanner.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// Volume elements that are refused, by keyword and by its code in binary files (libmeshb).
struct Refused {
  const char* keyword;
  int32_t code;
  const char* name;
};
constexpr Refused kRefused[] = {
    {"Hexahedra", 10, "hexahedron"},
    {"Prisms", 9, "prism"},
    {"Pentahedra", 9, "prism"},
    {"Pyramids", 49, "pyramid"},
    {"TetrahedraP2", 30, "10-node tetrahedron"},
    {"HexahedraQ2", 33, "27-node hexahedron"},
};

constexpr int32_t kBinaryDimension = 3;
constexpr int32_t kBinaryVertices = 4;
constexpr int32_t kBinaryTetrahedra = 8;
constexpr int32_t kBinaryEnd = 54;

int32_t Region(int64_t reference, Scanner& scan) {
  if (reference < std::numeric_limits<int32_t>::min() ||
      reference > std::numeric_limits<int32_t>::max()) {
    scan.Fail(absl::StrCat("reference ", reference, " does not fit in 32 bits"));
    return 0;
  }
  return static_cast<int32_t>(reference);
}

void RequireDimension(int64_t dimension, Scanner& scan) {
  if (scan.ok() && dimension != 3)
    scan.Fail(absl::StrCat("the dimension is ", dimension, "; tetrahedra need 3"));
}

}  // namespace

absl::StatusOr<TetMesh> ParseMeditText(absl::string_view bytes) {
  Scanner scan(bytes);
  scan.SetComment('#');
  MeshBuilder builder;
  scan.Expect("MeshVersionFormatted");
  scan.Integer("the format's version");
  while (scan.ok() && !scan.AtEnd()) {
    const absl::string_view keyword = scan.Token("a keyword");
    if (!absl::ascii_isalpha(static_cast<unsigned char>(keyword[0]))) {
      scan.Fail(
          absl::StrCat("expected a keyword such as Vertices, found `", keyword.substr(0, 40), "`"));
    } else if (keyword == "Dimension") {
      RequireDimension(scan.Integer("the dimension"), scan);
    } else if (keyword == "Vertices") {
      const int64_t count = scan.Count("the number of vertices");
      for (int64_t i = 0; i < count && scan.ok(); ++i) {
        Vec3 position;
        for (double& coordinate : position) coordinate = scan.Number("a coordinate");
        scan.Integer("the reference of a vertex");
        if (scan.ok()) builder.AddNode(builder.node_count() + 1, position);
      }
    } else if (keyword == "Tetrahedra") {
      const int64_t count = scan.Count("the number of tetrahedra");
      for (int64_t i = 0; i < count && scan.ok(); ++i) {
        std::array<int64_t, 4> nodes;
        for (int64_t& node : nodes) node = scan.Integer("a vertex of a tetrahedron");
        const int32_t region = Region(scan.Integer("the reference of a tetrahedron"), scan);
        if (scan.ok()) builder.AddTet(builder.tet_count() + 1, nodes, region);
      }
    } else if (keyword == "End") {
      break;
    } else {
      const Refused* const refused =
          std::find_if(std::begin(kRefused), std::end(kRefused),
                       [&](const Refused& row) { return keyword == row.keyword; });
      if (refused != std::end(kRefused) && scan.Count("a number of elements") > 0)
        return RefuseElement(absl::StrCat("line ", scan.Line(), ": an element"), refused->name);
      // Lists that are not needed: numbers up to the next keyword.
      while (scan.ok()) {
        const absl::string_view next = scan.PeekToken();
        if (next.empty() || absl::ascii_isalpha(static_cast<unsigned char>(next[0]))) break;
        scan.Token("a number");
      }
    }
  }
  CLEAVE_RETURN_IF_ERROR(scan.status());
  return builder.Finish();
}

bool IsMeditBinary(absl::string_view bytes) {
  if (bytes.size() < 8) return false;
  int32_t words[2];
  std::memcpy(words, bytes.data(), sizeof(words));
  if (words[0] == 0x01000000) return words[1] >= 0x01000000 && words[1] <= 0x04000000;
  return words[0] == 1 && words[1] >= 1 && words[1] <= 4;
}

absl::StatusOr<TetMesh> ParseMeditBinary(absl::string_view bytes) {
  Scanner scan(bytes);
  MeshBuilder builder;
  if (!IsMeditBinary(bytes)) {
    return absl::InvalidArgumentError(
        "byte 0: expected 1 and a version from 1 to 4, in either byte order");
  }
  scan.SetSwapped(scan.Binary<int32_t>("the byte order mark") != 1);
  const auto version = scan.Binary<int32_t>("the format's version");
  const auto position = [&] {
    return version >= 3 ? scan.Binary<int64_t>("where the next list starts")
                        : int64_t{scan.Binary<int32_t>("where the next list starts")};
  };
  const auto integer = [&](absl::string_view what) {
    return version >= 4 ? scan.Binary<int64_t>(what) : int64_t{scan.Binary<int32_t>(what)};
  };
  while (scan.ok() && scan.left() > 0) {
    const auto code = scan.Binary<int32_t>("a keyword's code");
    if (code == kBinaryEnd) break;
    const int64_t next = position();
    if (!scan.ok()) break;
    if (next != 0 && next <= static_cast<int64_t>(scan.offset())) {
      scan.FailAtByte(absl::StrCat("the next list is said to start at byte ", next, ", behind"));
      break;
    }
    if (code == kBinaryDimension) {
      RequireDimension(scan.Binary<int32_t>("the dimension"), scan);
    } else if (code == kBinaryVertices) {
      const int64_t count = integer("the number of vertices");
      for (int64_t i = 0; i < count && scan.ok(); ++i) {
        Vec3 at;
        for (double& coordinate : at) {
          coordinate = version == 1 ? double{scan.Binary<float>("a coordinate")}
                                    : scan.Binary<double>("a coordinate");
        }
        integer("the reference of a vertex");
        if (scan.ok()) builder.AddNode(builder.node_count() + 1, at);
      }
    } else if (code == kBinaryTetrahedra) {
      const int64_t count = integer("the number of tetrahedra");
      for (int64_t i = 0; i < count && scan.ok(); ++i) {
        std::array<int64_t, 4> nodes;
        for (int64_t& node : nodes) node = integer("a vertex of a tetrahedron");
        const int32_t region = Region(integer("the reference of a tetrahedron"), scan);
        if (scan.ok()) builder.AddTet(builder.tet_count() + 1, nodes, region);
      }
    } else {
      const Refused* const refused =
          std::find_if(std::begin(kRefused), std::end(kRefused),
                       [&](const Refused& row) { return code == row.code; });
      if (refused != std::end(kRefused) && integer("a number of elements") > 0)
        return RefuseElement(absl::StrCat("byte ", scan.offset(), ": an element"), refused->name);
    }
    if (next == 0) break;
    scan.SeekTo(static_cast<uint64_t>(next), "the next list");
  }
  CLEAVE_RETURN_IF_ERROR(scan.status());
  return builder.Finish();
}

}  // namespace cleave

#include "client/io/mesh/vega.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/scanner.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr char kAllElements[] = "allElements";  // a set that every file has

class VegaReader {
 public:
  explicit VegaReader(absl::string_view bytes) : scan_(bytes) { scan_.SetComment('#'); }

  absl::StatusOr<TetMesh> Read() {
    while (scan_.ok() && !scan_.AtEnd()) {
      const std::string keyword = absl::AsciiStrToUpper(scan_.Token("a keyword"));
      if (keyword == "*VERTICES") {
        ReadVertices();
      } else if (keyword == "*ELEMENTS") {
        CLEAVE_RETURN_IF_ERROR(ReadElements());
      } else if (keyword == "*SET") {
        ReadSet();
      } else if (keyword == "*REGION") {
        std::string set(scan_.Token("the name of a set"));
        scan_.Token("the name of a material");
        regions_.push_back(std::move(set));
      } else if (keyword == "*MATERIAL") {
        scan_.Token("the name of a material");
        while (scan_.ok() && !scan_.PeekToken().empty() && scan_.PeekToken()[0] != '*')
          scan_.Token("a material's value");
      } else if (keyword == "*INCLUDE") {
        scan_.Fail("*INCLUDE is not followed; put the included file's content in its place");
      } else {
        scan_.Fail(absl::StrCat("expected a keyword such as *VERTICES, found `",
                                keyword.substr(0, 40), "`"));
      }
    }
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    CLEAVE_RETURN_IF_ERROR(SetRegions());
    return builder_.Finish();
  }

 private:
  void ReadVertices() {
    const int64_t count = scan_.Count("the number of vertices");
    const int64_t dimension = scan_.Count("the dimension");
    if (scan_.ok() && dimension != 3)
      scan_.Fail(absl::StrCat("the dimension is ", dimension, "; tetrahedra need 3"));
    const int64_t attributes = scan_.Count("the number of attributes");
    scan_.Count("the number of markers");
    if (scan_.ok() && attributes > 0) scan_.Fail("vertices with attributes cannot be read");
    for (int64_t i = 0; i < count && scan_.ok(); ++i) {
      const int64_t number = scan_.Integer("the number of a vertex");
      Vec3 position;
      for (double& coordinate : position) coordinate = scan_.Number("a coordinate");
      if (scan_.ok()) builder_.AddNode(number, position);
    }
  }

  absl::Status ReadElements() {
    const absl::string_view kind = scan_.Token("TET or CUBIC");
    const int64_t count = scan_.Count("the number of elements");
    const int64_t corners = scan_.Count("the number of vertices of an element");
    scan_.Count("the number of attributes");
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    if (!absl::StartsWithIgnoreCase(kind, "TET") || corners != 4) {
      return RefuseElement(absl::StrCat("line ", scan_.Line(), ": every element"),
                           absl::StartsWithIgnoreCase(kind, "CUBIC")
                               ? "hexahedron"
                               : absl::StrCat(kind.substr(0, 40), " of ", corners, " vertices"));
    }
    for (int64_t i = 0; i < count && scan_.ok(); ++i) {
      const int64_t number = scan_.Integer("the number of an element");
      std::array<int64_t, 4> nodes;
      for (int64_t& node : nodes) node = scan_.Integer("a vertex of an element");
      if (!scan_.ok()) break;
      elements_.push_back({number, builder_.tet_count()});
      builder_.AddTet(number, nodes, 0);
    }
    return scan_.status();
  }

  void ReadSet() {
    std::vector<int64_t>& set = sets_[std::string(scan_.Token("the name of a set"))];
    while (scan_.ok() && !scan_.PeekToken().empty() && scan_.PeekToken()[0] != '*')
      set.push_back(scan_.Integer("the number of an element"));
  }

  absl::Status SetRegions() {
    std::sort(elements_.begin(), elements_.end());
    // Regions of one set are one region, at the place of the last.
    std::map<std::string, size_t> last;
    for (size_t i = 0; i < regions_.size(); ++i) last[regions_[i]] = i;
    int32_t id = 0;
    for (size_t i = 0; i < regions_.size(); ++i) {
      const std::string& name = regions_[i];
      if (last[name] != i) continue;
      builder_.NameRegion(++id, name);
      if (name == kAllElements) {
        for (int64_t tet = 0; tet < builder_.tet_count(); ++tet) builder_.SetRegion(tet, id);
        continue;
      }
      const auto set = sets_.find(name);
      if (set == sets_.end()) {
        return absl::InvalidArgumentError(
            absl::StrCat("*REGION names the set `", name.substr(0, 40), "`, which is not there"));
      }
      for (const int64_t number : set->second) {
        const auto found =
            std::lower_bound(elements_.begin(), elements_.end(), std::pair(number, int64_t{-1}));
        if (found == elements_.end() || found->first != number) {
          return absl::InvalidArgumentError(absl::StrCat(
              "the set `", name.substr(0, 40), "` names element ", number, ", which is not there"));
        }
        builder_.SetRegion(found->second, id);
      }
    }
    return absl::OkStatus();
  }

  Scanner scan_;
  MeshBuilder builder_;
  std::vector<std::pair<int64_t, int64_t>> elements_;  // number, tet
  std::map<std::string, std::vector<int64_t>> sets_;
  std::vector<std::string> regions_;  // set names in the order of *REGION
};

}  // namespace

absl::StatusOr<TetMesh> ParseVega(absl::string_view bytes) {
  // Values are separated by blanks, commas or both.
  std::string text(bytes);
  std::replace(text.begin(), text.end(), ',', ' ');
  return VegaReader(text).Read();
}

}  // namespace cleave

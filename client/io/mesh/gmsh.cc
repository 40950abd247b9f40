#include "client/io/mesh/gmsh.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/scanner.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct ElementType {
  int64_t id;
  int nodes;
  const char* name;
  enum { kTet, kPassedOver, kRefused } use;
};

// The element types of the Gmsh reference manual that its mesh generators write.
constexpr ElementType kElementTypes[] = {
    {1, 2, "line", ElementType::kPassedOver},
    {2, 3, "triangle", ElementType::kPassedOver},
    {3, 4, "quadrangle", ElementType::kPassedOver},
    {4, 4, "tetrahedron", ElementType::kTet},
    {5, 8, "hexahedron", ElementType::kRefused},
    {6, 6, "prism", ElementType::kRefused},
    {7, 5, "pyramid", ElementType::kRefused},
    {8, 3, "line", ElementType::kPassedOver},
    {9, 6, "triangle", ElementType::kPassedOver},
    {10, 9, "quadrangle", ElementType::kPassedOver},
    {11, 10, "10-node tetrahedron", ElementType::kRefused},
    {12, 27, "27-node hexahedron", ElementType::kRefused},
    {13, 18, "18-node prism", ElementType::kRefused},
    {14, 14, "14-node pyramid", ElementType::kRefused},
    {15, 1, "point", ElementType::kPassedOver},
    {16, 8, "quadrangle", ElementType::kPassedOver},
    {17, 20, "20-node hexahedron", ElementType::kRefused},
    {18, 15, "15-node prism", ElementType::kRefused},
    {19, 13, "13-node pyramid", ElementType::kRefused},
    {20, 9, "triangle", ElementType::kPassedOver},
    {21, 10, "triangle", ElementType::kPassedOver},
    {22, 12, "triangle", ElementType::kPassedOver},
    {23, 15, "triangle", ElementType::kPassedOver},
    {24, 15, "triangle", ElementType::kPassedOver},
    {25, 21, "triangle", ElementType::kPassedOver},
    {26, 4, "line", ElementType::kPassedOver},
    {27, 5, "line", ElementType::kPassedOver},
    {28, 6, "line", ElementType::kPassedOver},
    {29, 20, "20-node tetrahedron", ElementType::kRefused},
    {30, 35, "35-node tetrahedron", ElementType::kRefused},
    {31, 56, "56-node tetrahedron", ElementType::kRefused},
    {92, 64, "64-node hexahedron", ElementType::kRefused},
    {93, 125, "125-node hexahedron", ElementType::kRefused},
};

class GmshReader {
 public:
  explicit GmshReader(absl::string_view bytes) : scan_(bytes) {}

  absl::StatusOr<TetMesh> Read() {
    CLEAVE_RETURN_IF_ERROR(ReadFormat());
    bool nodes = false;
    bool elements = false;
    while (scan_.ok() && !scan_.AtEnd()) {
      const absl::string_view section = scan_.Token("a section");
      if (!absl::StartsWith(section, "$")) {
        Fail(
            absl::StrCat("expected a section such as $Nodes, found `", section.substr(0, 40), "`"));
        break;
      }
      scan_.RestOfLine();
      if (section == "$PhysicalNames") {
        ReadPhysicalNames();
      } else if (section == "$Entities" && version_ == 4) {
        ReadEntities();
      } else if (section == "$PartitionedEntities") {
        Fail("the mesh is partitioned; save it whole (Gmsh: `-part 0`)");
      } else if (section == "$Nodes") {
        nodes = true;
        version_ == 4 ? ReadNodes4() : ReadNodes2();
      } else if (section == "$Elements") {
        elements = true;
        version_ == 4 ? ReadElements4() : ReadElements2();
      } else {
        scan_.SkipPastLine(absl::StrCat("$End", section.substr(1)));
        continue;
      }
      scan_.Expect(absl::StrCat("$End", section.substr(1)));
    }
    CLEAVE_RETURN_IF_ERROR(refused_);
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    if (!nodes || !elements) {
      return absl::InvalidArgumentError(
          absl::StrCat("the file has no $", nodes ? "Elements" : "Nodes", " section"));
    }
    return builder_.Finish();
  }

 private:
  absl::Status ReadFormat() {
    scan_.Expect("$MeshFormat");
    const absl::string_view version = scan_.Token("the format's version");
    const int64_t binary = scan_.Integer("0 for ASCII or 1 for binary");
    const int64_t size = scan_.Integer("the size of numbers");
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    if (version == "2.2" || version == "2.1" || version == "2" || version == "2.0") {
      version_ = 2;
    } else if (version == "4.1") {
      version_ = 4;
    } else {
      Fail(absl::StrCat("format version ", version.substr(0, 20),
                        " cannot be read; save as 2.2 or 4.1 (Gmsh: `-format msh41`)"));
    }
    if (binary != 0 && binary != 1) Fail("the file type is neither 0 (ASCII) nor 1 (binary)");
    if (size != 8 && !(size == 4 && version_ == 4))
      Fail(absl::StrCat("numbers of ", size, " bytes cannot be read; 8 can"));
    binary_ = binary == 1;
    wide_ = size == 8;
    if (binary_) {
      scan_.RestOfLine();
      const auto one = scan_.Binary<int32_t>("the byte order mark");
      if (one == 0x01000000) scan_.SetSwapped(true);
      if (one != 1 && one != 0x01000000)
        scan_.FailAtByte("the byte order mark is not 1 in either order");
    }
    scan_.Expect("$EndMeshFormat");
    return scan_.status();
  }

  void Fail(absl::string_view message) {
    binary_ ? scan_.FailAtByte(message) : scan_.Fail(message);
  }

  // Values as the file's type has them, by the names of the reference manual.
  int64_t Int(absl::string_view what) {
    return binary_ ? scan_.Binary<int32_t>(what) : scan_.Integer(what);
  }
  int64_t Size(absl::string_view what) {
    if (!binary_) return scan_.Count(what);
    const uint64_t value =
        wide_ ? scan_.Binary<uint64_t>(what) : uint64_t{scan_.Binary<uint32_t>(what)};
    if (value > static_cast<uint64_t>(std::numeric_limits<int64_t>::max())) {
      scan_.FailAtByte(absl::StrCat(what, " is ", value));
      return 0;
    }
    return static_cast<int64_t>(value);
  }
  double Double(absl::string_view what) {
    return binary_ ? scan_.Binary<double>(what) : scan_.Number(what);
  }
  Vec3 Position() {
    Vec3 position;
    for (double& coordinate : position) coordinate = Double("a coordinate");
    return position;
  }
  void SkipDoubles(int64_t count) {
    for (int64_t i = 0; i < count && scan_.ok(); ++i) Double("a number");
  }
  void SkipInts(int64_t count) {
    for (int64_t i = 0; i < count && scan_.ok(); ++i) Int("a tag");
  }

  // `number` as a region id; Gmsh may give a group's tag a sign for its orientation.
  int32_t Region(int64_t number) {
    constexpr int64_t kMost = std::numeric_limits<int32_t>::max();
    if (number >= -kMost && number <= kMost) return static_cast<int32_t>(std::abs(number));
    Fail(absl::StrCat("physical group ", number, " does not fit in 31 bits"));
    return 0;
  }

  void ReadPhysicalNames() {
    const int64_t count = scan_.Count("the number of physical names");
    for (int64_t i = 0; i < count && scan_.ok(); ++i) {
      const int64_t dimension = scan_.Integer("the dimension of a physical group");
      const int32_t id = Region(scan_.Integer("the number of a physical group"));
      absl::string_view name = scan_.RestOfLine();
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') {
        Fail("expected the name of a physical group in double quotes");
        return;
      }
      if (dimension == 3) builder_.NameRegion(id, std::string(name.substr(1, name.size() - 2)));
    }
  }

  void ReadEntities() {
    int64_t counts[4];
    for (int64_t& count : counts) count = Size("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (int64_t i = 0; i < counts[dimension] && scan_.ok(); ++i) {
        const int64_t tag = Int("the tag of an entity");
        SkipDoubles(dimension == 0 ? 3 : 6);
        const int64_t groups = Size("the number of physical groups");
        for (int64_t group = 0; group < groups && scan_.ok(); ++group) {
          const int32_t region = Region(Int("a physical group"));
          if (dimension == 3 && group == 0) volume_regions_[tag] = region;
        }
        if (dimension > 0) SkipInts(Size("the number of bounding entities"));
      }
    }
  }

  void ReadNodes2() {
    const int64_t count = scan_.Count("the number of nodes");
    if (binary_) scan_.RestOfLine();
    for (int64_t i = 0; i < count && scan_.ok(); ++i) {
      const int64_t number = Int("the number of a node");
      builder_.AddNode(number, Position());
    }
  }

  void ReadNodes4() {
    const int64_t blocks = Size("the number of node blocks");
    for (int i = 0; i < 3; ++i) Size("the numbers of nodes");
    std::vector<int64_t> numbers;
    for (int64_t block = 0; block < blocks && scan_.ok(); ++block) {
      const int64_t dimension = Int("the dimension of a node block");
      Int("the entity of a node block");
      const int64_t parametric = Int("whether nodes are parametric");
      const int64_t count = Size("the number of nodes in the block");
      if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1) {
        Fail("the header of a node block is out of range");
        return;
      }
      numbers.clear();
      for (int64_t i = 0; i < count && scan_.ok(); ++i) numbers.push_back(Size("a node's number"));
      for (size_t i = 0; i < numbers.size() && scan_.ok(); ++i) {
        builder_.AddNode(numbers[i], Position());
        if (parametric == 1) SkipDoubles(dimension);
      }
    }
  }

  // The table's row for a type, or null after telling why not. `first` is the number of the first
  // such element, where it is known.
  const ElementType* TypeOf(int64_t id, absl::string_view where) {
    for (const ElementType& type : kElementTypes) {
      if (type.id != id) continue;
      if (type.use != ElementType::kRefused) return &type;
      if (refused_.ok()) refused_ = RefuseElement(where, type.name);
      return nullptr;
    }
    Fail(absl::StrCat(where, " has type ", id, ", which is not one that Gmsh meshes with"));
    return nullptr;
  }

  // Reads the nodes of one element and keeps it if it is a tet.
  template <typename ReadNode>
  void TakeElement(const ElementType& type, int64_t number, int32_t region,
                   const ReadNode& read_node) {
    if (type.use != ElementType::kTet) {
      for (int k = 0; k < type.nodes; ++k) read_node();
      return;
    }
    std::array<int64_t, 4> nodes;
    for (int64_t& node : nodes) node = read_node();
    if (scan_.ok()) builder_.AddTet(number, nodes, region);
  }

  void ReadElements2() {
    const int64_t count = scan_.Count("the number of elements");
    if (binary_) scan_.RestOfLine();
    const auto read_node = [&] { return Int("a node of an element"); };
    for (int64_t done = 0; done < count && scan_.ok() && refused_.ok();) {
      // ASCII: number, type, tag count, tags, nodes. Binary: blocks of a type, how many elements
      // follow and the tag count, then number, tags and nodes of each.
      const int64_t leading = Int(binary_ ? "an element type" : "the number of an element");
      const int64_t second = Int(binary_ ? "how many elements follow" : "an element type");
      const int64_t tags = Int("the number of tags");
      if (!scan_.ok()) return;
      const int64_t follow = binary_ ? second : 1;
      const ElementType* type = TypeOf(
          binary_ ? leading : second, binary_ ? absl::StrCat("the element at byte ", scan_.offset())
                                              : absl::StrCat("element ", leading));
      if (type == nullptr) return;
      if (follow < 1 || follow > count - done || tags < 0) {
        Fail(absl::StrCat("a block of ", follow, " elements with ", tags, " tags does not fit ",
                          count, " elements"));
        return;
      }
      for (int64_t i = 0; i < follow && scan_.ok(); ++i, ++done) {
        const int64_t number = binary_ ? Int("the number of an element") : leading;
        const int64_t group = tags > 0 ? Int("a physical group") : 0;
        SkipInts(tags - 1);
        TakeElement(*type, number, type->use == ElementType::kTet ? Region(group) : 0, read_node);
      }
    }
  }

  void ReadElements4() {
    const int64_t blocks = Size("the number of element blocks");
    for (int i = 0; i < 3; ++i) Size("the numbers of elements");
    const auto read_node = [&] { return Size("a node of an element"); };
    for (int64_t block = 0; block < blocks && scan_.ok() && refused_.ok(); ++block) {
      const int64_t dimension = Int("the dimension of an element block");
      const int64_t entity = Int("the entity of an element block");
      const int64_t type_id = Int("an element type");
      const int64_t count = Size("the number of elements in the block");
      if (!scan_.ok()) return;
      if (count == 0) continue;
      const ElementType* type =
          TypeOf(type_id, absl::StrCat("element block ", block, " of volume ", entity));
      if (type == nullptr) return;
      const auto volume = volume_regions_.find(entity);
      const int32_t region = dimension == 3 && volume != volume_regions_.end() ? volume->second : 0;
      for (int64_t i = 0; i < count && scan_.ok(); ++i) {
        const int64_t number = Size("the number of an element");
        TakeElement(*type, number, region, read_node);
      }
    }
  }

  Scanner scan_;
  MeshBuilder builder_;
  absl::Status refused_;
  int version_ = 0;
  bool binary_ = false;
  bool wide_ = true;
  std::map<int64_t, int32_t> volume_regions_;  // first physical group by entity tag
};

}  // namespace

absl::StatusOr<TetMesh> ParseGmsh(absl::string_view bytes) { return GmshReader(bytes).Read(); }

}  // namespace cleave

#ifndef CLEAVE_CORE_DAMAGE_NAMED_PIECES_H_
#define CLEAVE_CORE_DAMAGE_NAMED_PIECES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What became of a part of a piece that split.
struct PiecePart {
  int32_t piece = 0;       // its id from now on
  int32_t first_node = 0;  // the smallest of its nodes, by client id where there are NodeNames
  int64_t node_count = 0;
  double volume = 0;  // m^3 at rest: a quarter of each tet a node
};

struct PieceSplit {
  int32_t piece = 0;             // that split
  std::vector<PiecePart> parts;  // the one that keeps the id, then the new ones by ascending id
};

// Where the nodes of a mesh are numbered otherwise than the client's: both ways, a node each.
struct NodeNames {
  std::span<const int32_t> of_node;  // the client's id; empty: node ids are the client's
  std::span<const int32_t> to_node;
};

// The pieces of a mesh, nodes that unbroken edges join, under ids that last: a piece that splits
// hands its id to the part of the largest rest volume (of equal ones, to the one with the smallest
// node), and the others get the next free ids, the larger first. So ids count from 0 without gaps,
// follow from the mesh and the sequence of sets of edges that broke, and are the same for whoever
// is given those, in whatever order the mesh is numbered. Volumes are compared as exact integers.
//
// Not thread-safe.
class NamedPieces {
 public:
  // All edges unbroken; the pieces of the mesh itself are named as if they had split off.
  // `incidence` and what `names` shows must outlive this object.
  NamedPieces(const TetMesh& mesh, const Incidence& incidence, const NodeNames& names = {});

  // Breaks edges, ids in range, all of them at once: whole ones break, broken ones stay so. Returns
  // the pieces that split, by ascending id, until the next call. The work grows with the smaller
  // parts and with how far one walks round the breaks, not with the body.
  std::span<const PieceSplit> Break(std::span<const int32_t> edges);

  int32_t count() const { return static_cast<int32_t>(pieces_.size()); }
  int32_t piece_of(int32_t node) const {  // -1 for a node of no tet
    const int32_t label = labels_[static_cast<size_t>(node)];
    return label < 0 ? -1 : label_pieces_[static_cast<size_t>(label)];
  }
  double volume(int32_t piece) const;  // m^3 at rest
  bool broken(int32_t edge) const { return broken_[static_cast<size_t>(edge)] != 0; }
  // The smallest node of each piece. Together with the broken edges this is the whole state.
  std::vector<int32_t> FirstNodes() const;
  // Bytes of an object for so many of each, every node a piece at worst.
  static int64_t BytesOf(int64_t nodes, int64_t edges) {
    return edges +
           nodes * static_cast<int64_t>(sizeof(int64_t) + 3 * sizeof(int32_t) + sizeof(Piece));
  }
  // Goes back, or on, to a state. Returns whether there is a node of each piece in `first_nodes`
  // and nothing else; if not, nothing changed.
  bool Reset(std::span<const int32_t> broken_edges, std::span<const int32_t> first_nodes);

 private:
  struct Piece {
    int32_t label;
    int32_t first_name;  // the client's id of its smallest node
    int64_t node_count;
    int64_t units;  // of volume
  };
  // A part of a piece, while it splits.
  struct Part {
    int32_t piece;  // that it is of
    int32_t label;
    Piece what;
  };

  int32_t NameOf(int32_t node) const {
    return names_.of_node.empty() ? node : names_.of_node[static_cast<size_t>(node)];
  }
  int32_t NodeOf(int32_t name) const {
    return names_.to_node.empty() ? name : names_.to_node[static_cast<size_t>(name)];
  }
  static bool IsLarger(const Piece& a, const Piece& b) {
    return a.units != b.units ? a.units > b.units : a.first_name < b.first_name;
  }
  PiecePart Shown(int32_t piece) const;
  // Labels the components from 0 and returns them, in the order of their labels.
  std::vector<Piece> Flood();
  // Finds the parts of pieces that split, each remainder first; labels them.
  void FindParts(std::span<const int32_t> edges, std::vector<Part>& parts);

  const Incidence& incidence_;
  const NodeNames names_;
  double unit_ = 1;                  // m^3
  std::vector<int64_t> node_units_;  // a node each
  std::vector<uint8_t> broken_;      // an edge each
  std::vector<int32_t> labels_;      // a node each: an index of label_pieces_, or -1
  std::vector<int32_t> label_pieces_;
  std::vector<Piece> pieces_;
  std::vector<int32_t> owners_;  // a node each: the walk that has reached it, while splitting
  std::vector<PieceSplit> splits_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_NAMED_PIECES_H_

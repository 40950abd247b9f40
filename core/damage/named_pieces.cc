#include "core/damage/named_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

// Bits of the largest quarter of a tet, so that four of each tet sum up to less than 2^62.
int VolumeBits(int64_t tets) {
  const int count_bits = std::bit_width(static_cast<uint64_t>(4 * tets));
  return std::min(62 - count_bits, 52);
}

}  // namespace

NamedPieces::NamedPieces(const TetMesh& mesh, const Incidence& incidence, const NodeNames& names)
    : incidence_(incidence),
      names_(names),
      node_units_(mesh.rest_positions.size(), 0),
      broken_(incidence.edges.size(), 0),
      labels_(mesh.rest_positions.size(), -1),
      owners_(mesh.rest_positions.size(), -1) {
  // A power of two, so that the order of tets decides nothing.
  std::vector<double> quarters(mesh.tets.size());
  double largest = 0;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    double& quarter = quarters[static_cast<size_t>(tet)];
    quarter = std::abs(SignedVolume(CornersOf(mesh, tet))) / 4;
    largest = std::max(largest, quarter);
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  unit_ = std::ldexp(1.0, exponent - VolumeBits(mesh.tet_count()));
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const int64_t units = unit_ > 0 ? std::llround(quarters[tet] / unit_) : 0;
    for (const int32_t node : mesh.tets[tet]) node_units_[static_cast<size_t>(node)] += units;
  }
  pieces_ = Flood();
  std::sort(pieces_.begin(), pieces_.end(), IsLarger);
  label_pieces_.resize(pieces_.size());
  for (size_t piece = 0; piece < pieces_.size(); ++piece)
    label_pieces_[static_cast<size_t>(pieces_[piece].label)] = static_cast<int32_t>(piece);
}

std::vector<NamedPieces::Piece> NamedPieces::Flood() {
  std::fill(labels_.begin(), labels_.end(), -1);
  std::vector<Piece> found;
  std::vector<int32_t> queue;
  for (int32_t name = 0; name < static_cast<int32_t>(labels_.size()); ++name) {
    const int32_t first = NodeOf(name);
    if (labels_[static_cast<size_t>(first)] >= 0 || incidence_.node_edges[first].empty()) continue;
    const auto label = static_cast<int32_t>(found.size());
    Piece piece{label, name, 0, 0};
    labels_[static_cast<size_t>(first)] = label;
    queue.assign(1, first);
    while (!queue.empty()) {
      const int32_t node = queue.back();
      queue.pop_back();
      ++piece.node_count;
      piece.units += node_units_[static_cast<size_t>(node)];
      for (const int32_t edge : incidence_.node_edges[node]) {
        if (broken_[static_cast<size_t>(edge)] != 0) continue;
        const auto& [a, b] = incidence_.edges[static_cast<size_t>(edge)];
        int32_t& other = labels_[static_cast<size_t>(a == node ? b : a)];
        if (other >= 0) continue;
        other = label;
        queue.push_back(a == node ? b : a);
      }
    }
    found.push_back(piece);
  }
  return found;
}

// Walks start at all ends of the edges at once. Walks that meet become one; one that has nowhere
// left to go has walked a whole part. As soon as a piece has a single walk left, that one is in
// what remains of it and need not go on. In each round every walk takes as many nodes as any other,
// twice those of the round before: so what is small is walked to its end before much of what is
// large.
void NamedPieces::FindParts(std::span<const int32_t> edges, std::vector<Part>& parts) {
  constexpr int32_t kNone = -1;
  struct Visit {
    int32_t node;
    int32_t next;  // in the list of its walk, or kNone
  };
  struct Walk {
    int32_t joined;  // the walk that this one became part of, or itself
    int32_t piece;
    int32_t first;  // list of visits that have not had their turn, or kNone
    int32_t last;
    bool finished;
    Piece what;
  };
  std::vector<Visit> visits;
  std::vector<Walk> walks;
  std::vector<int32_t> going;  // walks that may have nodes to take
  std::vector<int32_t> open(pieces_.size(), 0);
  for (const int32_t edge : edges) {
    for (const int32_t node : incidence_.edges[static_cast<size_t>(edge)]) {
      int32_t& owner = owners_[static_cast<size_t>(node)];
      if (owner >= 0) continue;
      owner = static_cast<int32_t>(walks.size());
      const int32_t piece = piece_of(node);
      walks.push_back({owner,
                       piece,
                       owner,
                       owner,
                       false,
                       {kNone, NameOf(node), 1, node_units_[static_cast<size_t>(node)]}});
      visits.push_back({node, kNone});
      going.push_back(owner);
      ++open[static_cast<size_t>(piece)];
    }
  }
  const auto root_of = [&](int32_t walk) {
    while (walks[static_cast<size_t>(walk)].joined != walk) {
      int32_t& joined = walks[static_cast<size_t>(walk)].joined;
      joined = walks[static_cast<size_t>(joined)].joined;
      walk = joined;
    }
    return walk;
  };
  const auto append = [&](Walk& walk, int32_t first, int32_t last) {
    (walk.first == kNone ? walk.first : visits[static_cast<size_t>(walk.last)].next) = first;
    walk.last = last;
  };
  const auto add = [](Piece& to, const Piece& what) {
    to.first_name = std::min(to.first_name, what.first_name);
    to.node_count += what.node_count;
    to.units += what.units;
  };
  const auto take_node = [&](int32_t id, int32_t& still_open) {
    const Visit visit = visits[static_cast<size_t>(walks[static_cast<size_t>(id)].first)];
    Walk& walk = walks[static_cast<size_t>(id)];
    walk.first = visit.next;
    for (const int32_t edge : incidence_.node_edges[visit.node]) {
      if (broken_[static_cast<size_t>(edge)] != 0) continue;
      const auto& [a, b] = incidence_.edges[static_cast<size_t>(edge)];
      const int32_t other = a == visit.node ? b : a;
      int32_t& owner = owners_[static_cast<size_t>(other)];
      if (owner == id) continue;
      if (owner < 0) {
        owner = id;
        add(walk.what, {kNone, NameOf(other), 1, node_units_[static_cast<size_t>(other)]});
        const auto at = static_cast<int32_t>(visits.size());
        visits.push_back({other, kNone});
        append(walk, at, at);
        continue;
      }
      const int32_t met = root_of(owner);
      if (met == id) continue;
      Walk& other_walk = walks[static_cast<size_t>(met)];
      other_walk.joined = id;
      add(walk.what, other_walk.what);
      if (other_walk.first != kNone) append(walk, other_walk.first, other_walk.last);
      --still_open;
    }
    if (walk.first == kNone && still_open > 1) {
      walk.finished = true;
      --still_open;
    }
  };
  for (int64_t turns = 1; !going.empty(); turns *= 2) {
    size_t kept = 0;
    for (const int32_t id : going) {
      const Walk& walk = walks[static_cast<size_t>(id)];
      if (walk.joined != id) continue;
      int32_t& still_open = open[static_cast<size_t>(walk.piece)];
      for (int64_t turn = 0; turn < turns && still_open > 1 && walk.first != kNone; ++turn)
        take_node(id, still_open);
      if (still_open > 1 && walk.first != kNone) going[kept++] = id;
    }
    going.resize(kept);
  }
  // What came off takes labels of its own; what remains keeps its label, however large it is.
  std::vector<int32_t> remainders(pieces_.size(), kNone);  // indices of `parts`
  for (Walk& walk : walks) {
    if (!walk.finished) continue;
    int32_t& remainder = remainders[static_cast<size_t>(walk.piece)];
    if (remainder == kNone) {
      const Piece& whole = pieces_[static_cast<size_t>(walk.piece)];
      remainder = static_cast<int32_t>(parts.size());
      parts.push_back({walk.piece, whole.label, whole});
    }
    walk.what.label = static_cast<int32_t>(label_pieces_.size());
    label_pieces_.push_back(walk.piece);
    parts.push_back({walk.piece, walk.what.label, walk.what});
    Piece& rest = parts[static_cast<size_t>(remainder)].what;
    rest.node_count -= walk.what.node_count;
    rest.units -= walk.what.units;
  }
  for (const auto& [node, next] : visits) {
    int32_t& owner = owners_[static_cast<size_t>(node)];
    const Walk& root = walks[static_cast<size_t>(root_of(owner))];
    if (root.finished) labels_[static_cast<size_t>(node)] = root.what.label;
    owner = kNone;
  }
  // The smallest node of what remains never decreases, so all searches together pass a node once
  // for every piece that it has been the smallest of.
  for (const int32_t remainder : remainders) {
    if (remainder == kNone) continue;
    Part& part = parts[static_cast<size_t>(remainder)];
    while (labels_[static_cast<size_t>(NodeOf(part.what.first_name))] != part.label)
      ++part.what.first_name;
  }
}

std::span<const PieceSplit> NamedPieces::Break(std::span<const int32_t> edges) {
  splits_.clear();
  std::vector<int32_t> fresh;
  for (const int32_t edge : edges) {
    if (std::exchange(broken_[static_cast<size_t>(edge)], uint8_t{1}) == 0) fresh.push_back(edge);
  }
  std::vector<Part> parts;
  FindParts(fresh, parts);
  if (parts.empty()) return splits_;
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.piece != b.piece ? a.piece < b.piece : IsLarger(a.what, b.what);
  });
  std::vector<Part> named;
  for (size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    if (i == 0 || parts[i - 1].piece != part.piece) {
      pieces_[static_cast<size_t>(part.piece)] = part.what;
      label_pieces_[static_cast<size_t>(part.label)] = part.piece;
      splits_.push_back({part.piece, {Shown(part.piece)}});
    } else {
      named.push_back(part);
    }
  }
  std::sort(named.begin(), named.end(),
            [](const Part& a, const Part& b) { return IsLarger(a.what, b.what); });
  for (const Part& part : named) {
    const auto piece = static_cast<int32_t>(pieces_.size());
    pieces_.push_back(part.what);
    label_pieces_[static_cast<size_t>(part.label)] = piece;
    const auto split = std::lower_bound(
        splits_.begin(), splits_.end(), part.piece,
        [](const PieceSplit& candidate, int32_t id) { return candidate.piece < id; });
    split->parts.push_back(Shown(piece));
  }
  return splits_;
}

PiecePart NamedPieces::Shown(int32_t piece) const {
  const Piece& what = pieces_[static_cast<size_t>(piece)];
  return {piece, what.first_name, what.node_count, volume(piece)};
}

double NamedPieces::volume(int32_t piece) const {
  return static_cast<double>(pieces_[static_cast<size_t>(piece)].units) * unit_;
}

std::vector<int32_t> NamedPieces::FirstNodes() const {
  std::vector<int32_t> nodes;
  for (const Piece& piece : pieces_) nodes.push_back(piece.first_name);
  return nodes;
}

bool NamedPieces::Reset(std::span<const int32_t> broken_edges,
                        std::span<const int32_t> first_nodes) {
  const std::vector<uint8_t> broken_before = broken_;
  const std::vector<int32_t> labels_before = labels_;
  std::fill(broken_.begin(), broken_.end(), uint8_t{0});
  for (const int32_t edge : broken_edges) broken_[static_cast<size_t>(edge)] = 1;
  const std::vector<Piece> found = Flood();
  std::vector<int32_t> label_pieces(found.size(), -1);
  bool fits = found.size() == first_nodes.size();
  for (size_t piece = 0; fits && piece < first_nodes.size(); ++piece) {
    const int32_t name = first_nodes[piece];
    fits = name >= 0 && static_cast<size_t>(name) < labels_.size();
    const int32_t label = fits ? labels_[static_cast<size_t>(NodeOf(name))] : -1;
    fits = label >= 0 && found[static_cast<size_t>(label)].first_name == name &&
           label_pieces[static_cast<size_t>(label)] < 0;
    if (fits) label_pieces[static_cast<size_t>(label)] = static_cast<int32_t>(piece);
  }
  if (!fits) {
    broken_ = broken_before;
    labels_ = labels_before;
    return false;
  }
  label_pieces_ = std::move(label_pieces);
  pieces_.resize(found.size());
  for (const Piece& piece : found)
    pieces_[static_cast<size_t>(label_pieces_[static_cast<size_t>(piece.label)])] = piece;
  return true;
}

}  // namespace cleave

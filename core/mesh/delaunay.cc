#include "core/mesh/delaunay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/counter_rng.h"
#include "core/mesh/grid_predicates.h"
#include "core/mesh/morton.h"

namespace cleave {
namespace {

constexpr int32_t kInfinite = -1;
constexpr int32_t kNone = -1;
constexpr double kGridSteps = (1 << 23) - 1;

// A tet of the triangulation, or a ghost: a face of the hull joined to the vertex at infinity, so
// ordered that a point outside in its place makes positive volume.
struct Cell {
  std::array<int32_t, 4> nodes;
  std::array<int32_t, 4> neighbours;  // neighbours[i] is across the face opposite to nodes[i]
  uint32_t seen = 0;                  // insertion at which the cell was last judged
  bool conflict = false;              // the verdict
  bool alive = true;
};

class Triangulation {
 public:
  explicit Triangulation(std::vector<GridPoint> points) : points_(std::move(points)) {}

  // Makes the first tet of four points of `order`, and returns whether there is one.
  bool Start(const std::vector<int32_t>& order) {
    std::array<int32_t, 4> first = {kNone, kNone, kNone, kNone};
    size_t found = 0;
    for (const int32_t node : order) {
      first[found] = node;
      if (Independent(first, found)) ++found;
      if (found == 4) break;
    }
    if (found < 4) return false;
    if (Orientation(At(first[0]), At(first[1]), At(first[2]), At(first[3])) < 0)
      std::swap(first[2], first[3]);
    cells_.push_back({first, {1, 2, 3, 4}});
    for (int32_t i = 0; i < 4; ++i) {
      // The ghost behind face i: infinity in the place of node i, two others exchanged.
      Cell ghost{first, {}};
      ghost.nodes[static_cast<size_t>(i)] = kInfinite;
      const auto j = static_cast<size_t>(i + 1) % 4;
      const auto k = static_cast<size_t>(i + 2) % 4;
      std::swap(ghost.nodes[j], ghost.nodes[k]);
      for (size_t slot = 0; slot < 4; ++slot) {
        const int32_t node = ghost.nodes[slot];
        ghost.neighbours[slot] =
            node == kInfinite
                ? 0
                : 1 + static_cast<int32_t>(std::find(first.begin(), first.end(), node) -
                                           first.begin());
      }
      cells_.push_back(ghost);
    }
    used_ = first;
    return true;
  }

  void Insert(int32_t node) {
    if (std::find(used_.begin(), used_.end(), node) != used_.end()) return;
    const GridPoint& p = At(node);
    const int32_t start = Locate(p);
    ++insertion_;
    // A point that equals a node, or hides behind its weight, conflicts with nothing.
    if (!Conflicts(start, p)) return;
    Dig(start, p);
    Fill(node);
  }

  std::vector<std::array<int32_t, 4>> Tets() const {
    std::vector<std::array<int32_t, 4>> tets;
    for (const Cell& cell : cells_) {
      if (cell.alive && SlotOf(cell, kInfinite) == 4) tets.push_back(cell.nodes);
    }
    return tets;
  }

 private:
  // A face between a dug cell and one that stays.
  struct Wall {
    std::array<int32_t, 4> nodes;  // of the dug cell
    size_t slot;                   // whose place the new node takes
    int32_t behind;                // the cell that stays
    size_t behind_slot;            // its neighbour across the wall
  };
  // An edge of the walls, by which two new cells find each other.
  struct Rim {
    int32_t low = kNone;
    int32_t high = kNone;
    int32_t cell = kNone;
    size_t slot = 0;
  };

  const GridPoint& At(int32_t node) const { return points_[static_cast<size_t>(node)]; }

  // Whether nodes[count] does not lie in the span of the nodes before it.
  bool Independent(const std::array<int32_t, 4>& nodes, size_t count) const {
    const auto difference = [&](size_t i) {
      const GridPoint& a = At(nodes[0]);
      const GridPoint& b = At(nodes[i]);
      return Vec3{b.x - a.x, b.y - a.y, b.z - a.z};
    };
    if (count == 0) return true;
    const Vec3 last = difference(count);
    if (count == 1) return last[0] != 0 || last[1] != 0 || last[2] != 0;
    if (count == 3) return Orientation(At(nodes[0]), At(nodes[1]), At(nodes[2]), At(nodes[3])) != 0;
    const Vec3 u = difference(1);
    // Products of 23-bit differences: exact.
    return u[1] * last[2] != u[2] * last[1] || u[2] * last[0] != u[0] * last[2] ||
           u[0] * last[1] != u[1] * last[0];
  }

  static size_t SlotOf(const Cell& cell, int32_t node) {
    return static_cast<size_t>(std::find(cell.nodes.begin(), cell.nodes.end(), node) -
                               cell.nodes.begin());
  }

  // The volume's sign with p in the place of the cell's node `slot`.
  int SideOf(const Cell& cell, size_t slot, const GridPoint& p) const {
    std::array<const GridPoint*, 4> corners;
    for (size_t i = 0; i < 4; ++i) corners[i] = i == slot ? &p : &At(cell.nodes[i]);
    return Orientation(*corners[0], *corners[1], *corners[2], *corners[3]);
  }

  // Walks from the last cell made to one that holds p, or to a ghost that p lies outside of.
  int32_t Locate(const GridPoint& p) const {
    int32_t at = last_;
    const size_t infinite = SlotOf(cells_[static_cast<size_t>(at)], kInfinite);
    if (infinite < 4) at = cells_[static_cast<size_t>(at)].neighbours[infinite];
    int32_t from = kNone;
    while (true) {
      const Cell& cell = cells_[static_cast<size_t>(at)];
      if (SlotOf(cell, kInfinite) < 4) return at;
      bool moved = false;
      for (size_t slot = 0; slot < 4; ++slot) {
        if (cell.neighbours[slot] == from || SideOf(cell, slot, p) >= 0) continue;
        from = at;
        at = cell.neighbours[slot];
        moved = true;
        break;
      }
      if (!moved) return at;
    }
  }

  bool Conflicts(int32_t id, const GridPoint& p) {
    Cell& cell = cells_[static_cast<size_t>(id)];
    if (cell.seen == insertion_) return cell.conflict;
    const size_t infinite = SlotOf(cell, kInfinite);
    bool conflict = false;
    if (infinite == 4) {
      conflict = InSphere(At(cell.nodes[0]), At(cell.nodes[1]), At(cell.nodes[2]),
                          At(cell.nodes[3]), p) > 0;
    } else {
      const int side = SideOf(cell, infinite, p);
      // In the hull face's own plane, the sphere of the tet behind it cuts the face's circle.
      conflict = side > 0 || (side == 0 && Conflicts(cell.neighbours[infinite], p));
    }
    cell.seen = insertion_;
    cell.conflict = conflict;
    return conflict;
  }

  // Collects the cells in conflict with p and the walls round them.
  void Dig(int32_t start, const GridPoint& p) {
    dug_.assign(1, start);
    walls_.clear();
    cells_[static_cast<size_t>(start)].alive = false;
    for (size_t next = 0; next < dug_.size(); ++next) {
      const int32_t id = dug_[next];
      for (size_t slot = 0; slot < 4; ++slot) {
        const int32_t behind = cells_[static_cast<size_t>(id)].neighbours[slot];
        Cell& other = cells_[static_cast<size_t>(behind)];
        if (!other.alive) continue;
        if (Conflicts(behind, p)) {
          other.alive = false;
          dug_.push_back(behind);
        } else {
          const auto behind_slot =
              static_cast<size_t>(std::find(other.neighbours.begin(), other.neighbours.end(), id) -
                                  other.neighbours.begin());
          walls_.push_back({cells_[static_cast<size_t>(id)].nodes, slot, behind, behind_slot});
        }
      }
    }
  }

  // Joins `node` to every wall.
  void Fill(int32_t node) {
    free_.insert(free_.end(), dug_.begin(), dug_.end());
    size_t table_size = 64;
    while (table_size < 4 * walls_.size()) table_size *= 2;
    rims_.assign(table_size, Rim{});
    for (const Wall& wall : walls_) {
      if (free_.empty()) {
        free_.push_back(static_cast<int32_t>(cells_.size()));
        cells_.emplace_back();
      }
      last_ = free_.back();
      free_.pop_back();
      Cell& cell = cells_[static_cast<size_t>(last_)];
      cell = Cell{wall.nodes, {kNone, kNone, kNone, kNone}};
      cell.nodes[wall.slot] = node;
      cell.neighbours[wall.slot] = wall.behind;
      cells_[static_cast<size_t>(wall.behind)].neighbours[wall.behind_slot] = last_;
      for (size_t slot = 0; slot < 4; ++slot) {
        if (slot != wall.slot) JoinAtRim(last_, slot, wall.slot);
      }
    }
  }

  // Joins the cell's face opposite to nodes[slot] to the other new cell at the same rim, once that
  // is there. `apex` is the slot of the new node.
  void JoinAtRim(int32_t id, size_t slot, size_t apex) {
    Cell& cell = cells_[static_cast<size_t>(id)];
    std::array<int32_t, 2> ends;
    size_t count = 0;
    for (size_t i = 0; i < 4; ++i) {
      if (i != slot && i != apex) ends[count++] = cell.nodes[i];
    }
    const auto [low, high] = std::minmax(ends[0], ends[1]);
    const uint64_t key = uint64_t{static_cast<uint32_t>(low)} << 32 | static_cast<uint32_t>(high);
    size_t place = (key * 0x9E3779B97F4A7C15u >> 32) & (rims_.size() - 1);
    while (rims_[place].cell != kNone && (rims_[place].low != low || rims_[place].high != high))
      place = (place + 1) & (rims_.size() - 1);
    Rim& rim = rims_[place];
    if (rim.cell == kNone) {
      rim = {low, high, id, slot};
    } else {
      cell.neighbours[slot] = rim.cell;
      cells_[static_cast<size_t>(rim.cell)].neighbours[rim.slot] = id;
    }
  }

  std::vector<GridPoint> points_;
  std::vector<Cell> cells_;
  std::vector<int32_t> free_;
  std::array<int32_t, 4> used_{};
  uint32_t insertion_ = 0;
  int32_t last_ = 0;
  // Scratch of one insertion.
  std::vector<int32_t> dug_;
  std::vector<Wall> walls_;
  std::vector<Rim> rims_;
};

// Random halves of the points, the smallest first, each along a Morton curve: few cells are made
// for nothing, and the next point is never far.
std::vector<int32_t> InsertionOrder(const std::vector<Vec3>& points) {
  struct Key {
    int round;
    uint64_t code;
    int32_t node;
    bool operator<(const Key& other) const {
      if (round != other.round) return round > other.round;
      return code != other.code ? code < other.code : node < other.node;
    }
  };
  const MortonCurve curve(points);
  std::vector<Key> keys;
  keys.reserve(points.size());
  for (size_t node = 0; node < points.size(); ++node) {
    const double draw = UniformDraw(0, RandomStream::kMeshJitter, node, 0);
    const int round = std::min(20, -std::ilogb(draw));
    keys.push_back({round, curve.CodeOf(points[node]), static_cast<int32_t>(node)});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int32_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.node);
  return order;
}

std::vector<GridPoint> OnGrid(const std::vector<Vec3>& points) {
  Vec3 low;
  Vec3 high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Vec3& point : points) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
  const double side = std::max(
      {high[0] - low[0], high[1] - low[1], high[2] - low[2], std::numeric_limits<double>::min()});
  std::vector<GridPoint> grid;
  grid.reserve(points.size());
  for (size_t node = 0; node < points.size(); ++node) {
    const auto step = [&](size_t axis) {
      return std::round((points[node][axis] - low[axis]) / side * kGridSteps);
    };
    const double weight = std::floor(256 * UniformDraw(0, RandomStream::kMeshJitter, node, 1));
    grid.push_back({step(0), step(1), step(2), weight});
  }
  return grid;
}

}  // namespace

std::vector<std::array<int32_t, 4>> DelaunayTets(const std::vector<Vec3>& points) {
  if (points.size() < 4) return {};
  const std::vector<int32_t> order = InsertionOrder(points);
  Triangulation triangulation(OnGrid(points));
  if (!triangulation.Start(order)) return {};
  for (const int32_t node : order) triangulation.Insert(node);
  return triangulation.Tets();
}

}  // namespace cleave

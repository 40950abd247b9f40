#include "tests/metrics/pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/damage/components.h"
#include "core/surface/fragments.h"

namespace cleave {
namespace {

std::vector<uint8_t> Flags(const Incidence& incidence, std::span<const int32_t> broken_edges) {
  std::vector<uint8_t> broken(incidence.edges.size(), 0);
  for (const int32_t edge : broken_edges) broken[static_cast<size_t>(edge)] = 1;
  return broken;
}

std::vector<int32_t> Labels(const Incidence& incidence, std::span<const int32_t> broken_edges) {
  std::vector<int32_t> labels;
  LabelComponents(incidence, Flags(incidence, broken_edges), labels);
  return labels;
}

}  // namespace

Pieces PiecesOf(const TetMesh& mesh, const Incidence& incidence,
                std::span<const int32_t> broken_edges, double piece_share) {
  const Fragments fragments = FindFragments(mesh, incidence, broken_edges);
  double total = 0;
  for (const double volume : fragments.volumes) total += volume;
  Pieces pieces;
  std::vector<int32_t> piece_of(fragments.volumes.size(), -1);
  for (size_t fragment = 0; fragment < piece_of.size(); ++fragment) {
    const double share = fragments.volumes[fragment] / total;
    if (share >= piece_share) {
      piece_of[fragment] = pieces.count++;
      pieces.shares.push_back(share);
    } else {
      ++pieces.dust_count;
      pieces.dust_share += share;
    }
  }
  for (const int32_t fragment : fragments.node_fragments)
    pieces.node_pieces.push_back(fragment < 0 ? -1 : piece_of[static_cast<size_t>(fragment)]);
  return pieces;
}

BandShare ShareInBand(const Incidence& incidence, std::span<const int32_t> broken_edges,
                      std::span<const uint8_t> in_map) {
  const auto inside = [&](size_t edge) {
    const auto& [a, b] = incidence.edges[edge];
    return in_map[static_cast<size_t>(a)] != 0 && in_map[static_cast<size_t>(b)] != 0;
  };
  double in_band = 0, broken_in_band = 0;
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) in_band += inside(edge) ? 1 : 0;
  for (const int32_t edge : broken_edges)
    broken_in_band += inside(static_cast<size_t>(edge)) ? 1 : 0;
  BandShare share;
  share.base = in_band / static_cast<double>(incidence.edges.size());
  if (!broken_edges.empty()) share.band = broken_in_band / static_cast<double>(broken_edges.size());
  if (share.base > 0) share.lift = share.band / share.base;
  return share;
}

double JaccardWithin(const TetMesh& mesh, const Incidence& incidence, std::span<const int32_t> a,
                     std::span<const int32_t> b, double reach) {
  if (a.empty() && b.empty()) return 1;
  const auto middles = [&](std::span<const int32_t> edges) {
    std::vector<Vec3> found;
    for (const int32_t edge : edges) {
      const auto& [p, q] = incidence.edges[static_cast<size_t>(edge)];
      Vec3 middle{0, 0, 0};
      for (size_t axis = 0; axis < 3; ++axis)
        middle[axis] = (mesh.rest_positions[static_cast<size_t>(p)][axis] +
                        mesh.rest_positions[static_cast<size_t>(q)][axis]) /
                       2;
      found.push_back(middle);
    }
    return found;
  };
  const std::vector<Vec3> of_a = middles(a), of_b = middles(b);
  const auto near = [reach](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    return std::count_if(from.begin(), from.end(), [&](const Vec3& p) {
      return std::any_of(to.begin(), to.end(), [&](const Vec3& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= reach;
      });
    });
  };
  return static_cast<double>(near(of_a, of_b) + near(of_b, of_a)) /
         static_cast<double>(a.size() + b.size());
}

int64_t FirstFracture(std::span<const Frame> frames, int64_t edge_count, double share) {
  for (size_t i = 0; i < frames.size(); ++i) {
    if (static_cast<double>(frames[i].broken_edges.size()) >
        share * static_cast<double>(edge_count))
      return static_cast<int64_t>(i);
  }
  return -1;
}

int64_t Separation(const TetMesh& mesh, const Incidence& incidence, std::span<const Frame> frames,
                   std::span<const int32_t> grip, std::span<const int32_t> other_grip) {
  size_t last_count = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    // Nothing new broke: it is still whole.
    if (i > 0 && frames[i].broken_edges.size() == last_count) continue;
    last_count = frames[i].broken_edges.size();
    const std::vector<int32_t> labels = Labels(incidence, frames[i].broken_edges);
    std::vector<uint8_t> touched(static_cast<size_t>(mesh.node_count()), 0);
    for (const int32_t node : grip) {
      const int32_t label = labels[static_cast<size_t>(node)];
      if (label >= 0) touched[static_cast<size_t>(label)] = 1;
    }
    const bool joined = std::any_of(other_grip.begin(), other_grip.end(), [&](int32_t node) {
      const int32_t label = labels[static_cast<size_t>(node)];
      return label >= 0 && touched[static_cast<size_t>(label)] != 0;
    });
    if (!joined) return static_cast<int64_t>(i);
  }
  return -1;
}

int64_t CrackOpenTo(std::span<const Frame> frames, double share) {
  if (frames.empty() || frames.back().broken_edges.empty()) return -1;
  const double wanted = share * static_cast<double>(frames.back().broken_edges.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    if (static_cast<double>(frames[i].broken_edges.size()) >= wanted)
      return static_cast<int64_t>(i);
  }
  return -1;
}

std::vector<double> PartedShares(const TetMesh& mesh, const Incidence& incidence,
                                 std::span<const Frame> frames) {
  if (frames.empty()) return {};
  const Pieces pieces = PiecesOf(mesh, incidence, frames.back().broken_edges);
  const auto between_pieces = [&](int32_t edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const int32_t piece = pieces.node_pieces[static_cast<size_t>(a)];
    const int32_t other = pieces.node_pieces[static_cast<size_t>(b)];
    return piece >= 0 && other >= 0 && piece != other;
  };
  std::vector<double> shares;
  for (const Frame& frame : frames) {
    const std::vector<int32_t>& broken = frame.broken_edges;
    shares.push_back(
        static_cast<double>(std::count_if(broken.begin(), broken.end(), between_pieces)));
  }
  // Edges never mend, and in the last frame all that are between pieces are broken.
  const double all = shares.back();
  if (all == 0) return {};
  for (double& share : shares) share /= all;
  return shares;
}

double EdgeStretch(const TetMesh& mesh, const Incidence& incidence, const Frame& frame,
                   int32_t edge) {
  const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
  const auto length = [&](const std::vector<Vec3>& positions) {
    const Vec3& p = positions[static_cast<size_t>(a)];
    const Vec3& q = positions[static_cast<size_t>(b)];
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  };
  return length(frame.positions) / length(mesh.rest_positions);
}

std::vector<FailureStretch> FailureStretches(const TetMesh& mesh, const Incidence& incidence,
                                             std::span<const Frame> frames) {
  std::vector<FailureStretch> stretches;
  std::vector<uint8_t> seen(incidence.edges.size(), 0);
  for (size_t i = 0; i < frames.size(); ++i) {
    for (const int32_t edge : frames[i].broken_edges) {
      if (seen[static_cast<size_t>(edge)] != 0) continue;
      seen[static_cast<size_t>(edge)] = 1;
      if (i > 0) stretches.push_back({edge, EdgeStretch(mesh, incidence, frames[i - 1], edge)});
    }
  }
  std::sort(stretches.begin(), stretches.end(),
            [](const FailureStretch& a, const FailureStretch& b) { return a.edge < b.edge; });
  return stretches;
}

std::vector<int32_t> BridgingEdges(const Incidence& incidence, const Frame& frame,
                                   const Frame& last) {
  const std::vector<uint8_t> broken = Flags(incidence, frame.broken_edges);
  const std::vector<int32_t> labels = Labels(incidence, last.broken_edges);
  std::vector<int32_t> bridging;
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
    const auto& [a, b] = incidence.edges[edge];
    if (broken[edge] == 0 && labels[static_cast<size_t>(a)] != labels[static_cast<size_t>(b)])
      bridging.push_back(static_cast<int32_t>(edge));
  }
  return bridging;
}

double SmallestHold(const TetMesh& mesh, const Incidence& incidence,
                    std::span<const Frame> frames) {
  if (frames.empty()) return 1;
  const Pieces pieces = PiecesOf(mesh, incidence, frames.back().broken_edges);
  if (pieces.count < 2) return 1;
  const auto largest = static_cast<int32_t>(
      std::max_element(pieces.shares.begin(), pieces.shares.end()) - pieces.shares.begin());
  // The boundary edges of every piece.
  std::vector<std::vector<int32_t>> boundary(static_cast<size_t>(pieces.count));
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
    const int32_t a = pieces.node_pieces[static_cast<size_t>(incidence.edges[edge][0])];
    const int32_t b = pieces.node_pieces[static_cast<size_t>(incidence.edges[edge][1])];
    if (a == b) continue;
    for (const int32_t piece : {a, b}) {
      if (piece >= 0) boundary[static_cast<size_t>(piece)].push_back(static_cast<int32_t>(edge));
    }
  }
  double smallest = 1;
  for (const Frame& frame : frames) {
    const std::vector<uint8_t> broken = Flags(incidence, frame.broken_edges);
    for (int32_t piece = 0; piece < pieces.count; ++piece) {
      const std::vector<int32_t>& edges = boundary[static_cast<size_t>(piece)];
      if (piece == largest || edges.empty()) continue;
      const auto held = std::count_if(edges.begin(), edges.end(), [&](int32_t edge) {
        return broken[static_cast<size_t>(edge)] == 0;
      });
      if (held > 0)
        smallest =
            std::min(smallest, static_cast<double>(held) / static_cast<double>(edges.size()));
    }
  }
  return smallest;
}

}  // namespace cleave

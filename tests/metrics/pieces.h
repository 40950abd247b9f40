#ifndef CLEAVE_TESTS_METRICS_PIECES_H_
#define CLEAVE_TESTS_METRICS_PIECES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

// What a body broke into, when, and where.

namespace cleave {

// A component of nodes through unbroken edges is a piece when it holds at least this share of the
// body's rest volume; smaller ones are dust.
inline constexpr double kPieceShare = 0.005;

struct Pieces {
  int32_t count = 0;
  int32_t dust_count = 0;
  double dust_share = 0;             // of the rest volume
  std::vector<double> shares;        // of the rest volume, a piece each
  std::vector<int32_t> node_pieces;  // a node each; -1: dust, or of no tet
};
Pieces PiecesOf(const TetMesh& mesh, const Incidence& incidence,
                std::span<const int32_t> broken_edges, double piece_share = kPieceShare);

// How broken edges lie to a map. F_band = edges broken with both ends in it / edges broken; base =
// such edges / all edges; lift = F_band / base.
struct BandShare {
  double band = 0;  // F_band; 0 where nothing is broken
  double base = 0;
  double lift = 0;
};
BandShare ShareInBand(const Incidence& incidence, std::span<const int32_t> broken_edges,
                      std::span<const uint8_t> in_map);

// Of the edges broken in `a` and in `b`, each list counted by itself, the share whose middle at
// rest lies within `reach` (m) of that of one broken in the other: a Jaccard index of cracks rather
// than of ids. 1 for two empty lists.
double JaccardWithin(const TetMesh& mesh, const Incidence& incidence, std::span<const int32_t> a,
                     std::span<const int32_t> b, double reach);

// Frames of a run are positions in it, [0] at rest. -1: it never came to that.

// First frame with more than `share` of the edges broken.
int64_t FirstFracture(std::span<const Frame> frames, int64_t edge_count, double share = 0.001);

// First frame in which no path of unbroken edges leads from one grip to the other.
int64_t Separation(const TetMesh& mesh, const Incidence& incidence, std::span<const Frame> frames,
                   std::span<const int32_t> grip, std::span<const int32_t> other_grip);

// First frame with at least `share` of the edges that are broken in the last one.
int64_t CrackOpenTo(std::span<const Frame> frames, double share);

// Of the edges between pieces of the last frame, the share that is broken: how far the body has
// come apart, a frame each. What breaks elsewhere opens cracks that end within a piece; a body can
// be full of those before it begins to come apart. Empty where the last frame has no two pieces.
std::vector<double> PartedShares(const TetMesh& mesh, const Incidence& incidence,
                                 std::span<const Frame> frames);

// Distance over rest length of an edge.
double EdgeStretch(const TetMesh& mesh, const Incidence& incidence, const Frame& frame,
                   int32_t edge);

// Stretch of every edge that broke, in the last frame that still had it, by ascending edge.
struct FailureStretch {
  int32_t edge = 0;
  double stretch = 1;
};
std::vector<FailureStretch> FailureStretches(const TetMesh& mesh, const Incidence& incidence,
                                             std::span<const Frame> frames);

// Edges that hold together at `frame` what lies in different components in `last`: the strands
// across a tear.
std::vector<int32_t> BridgingEdges(const Incidence& incidence, const Frame& frame,
                                   const Frame& last);

// The smallest share > 0 of its final boundary by which any piece of the last frame (not the
// largest) hung on to the rest in some frame; 1 where none ever hung by less. The final boundary of
// a piece is the edges from it to the rest.
double SmallestHold(const TetMesh& mesh, const Incidence& incidence, std::span<const Frame> frames);

}  // namespace cleave

#endif  // CLEAVE_TESTS_METRICS_PIECES_H_

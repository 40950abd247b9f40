#ifndef CLEAVE_CORE_SURFACE_SURFACE_IDS_H_
#define CLEAVE_CORE_SURFACE_SURFACE_IDS_H_

#include <cstddef>
#include <cstdint>

namespace cleave {

// Names a point or triangle of a visible surface by what it is: a part of the mesh and, in its low
// byte, which of those there. Ids need no history, so seeking gives the same as reading on, and
// they last: where a crack splits a point, the copy with the first of its nodes keeps the id; a
// triangle keeps its own for as long as it spans the same corners, or copies of them. Points and
// triangles are numbered apart.
using SurfaceId = uint64_t;

namespace surface_id {

enum Kind : uint64_t {
  kNode,
  kEdge,
  kFace,
  kTet,
  kPinch,
  kOuter,
  kCrack,
  // Of a render mesh as it is divided.
  kRenderPoint,
  kRenderEdge,
  kRenderMiddle,
  kLoosePair,
  kLooseTriple,
  kRenderOuter,
  kRenderCrack,
  kRenderApex,
  kRenderCap,
};

constexpr SurfaceId Make(Kind kind, uint64_t part, uint64_t low) {
  return kind << 56 | part << 8 | low;
}
constexpr Kind KindOf(SurfaceId id) { return static_cast<Kind>(id >> 56); }
constexpr uint64_t PartOf(SurfaceId id) { return id >> 8 & ((uint64_t{1} << 36) - 1); }
constexpr uint64_t LowOf(SurfaceId id) { return id & 0xFF; }

// Of a point that stands for another fan of triangles round the same point (fans.h), from 1 on.
inline constexpr uint64_t kMaxFan = 0xFFF;
constexpr SurfaceId OfFan(SurfaceId id, uint64_t fan) { return id | fan << 44; }
// Where sheets that touch along an edge are parted (shared_edges.h): the point in the middle of
// side k of a triangle with that id, and the parts of a triangle with points on the sides in
// `mask`.
constexpr SurfaceId OfHalf(SurfaceId triangle, size_t k) {
  return triangle | static_cast<uint64_t>(k + 1) << 44;
}
constexpr SurfaceId OfPart(SurfaceId triangle, size_t mask, size_t part) {
  return triangle | static_cast<uint64_t>(mask << 2 | part) << 44;
}

// Points. `first` is the first node on the copy's side, by its place in the edge, in the face as
// the lower of its tets lists it, or in the tet. A face is 4 * tet + face of its lower tet.
constexpr SurfaceId OfNode(int32_t node) { return Make(kNode, static_cast<uint64_t>(node), 0); }
constexpr SurfaceId OfEdge(int32_t edge, size_t first) {
  return Make(kEdge, static_cast<uint64_t>(edge), first);
}
constexpr SurfaceId OfFace(size_t face, size_t first) { return Make(kFace, face, first); }
constexpr SurfaceId OfTet(size_t tet, size_t first) { return Make(kTet, tet, first); }
// On the segment from a face's point to the middle of its edge i; side 0 is that of the edge's
// smaller node.
constexpr SurfaceId OfPinch(size_t face, size_t i, size_t side) {
  return Make(kPinch, face, 2 * i + side);
}

// Points of a render mesh: a given one; where an edge is cut, 0 on the side of its first end; in a
// triangle between three nodes, on the side of the first of its corners `first`. Cracks inside have
// the points of tets, faces and edges; the loose ones are where there is no edge or face.
constexpr SurfaceId OfRenderPoint(size_t point) { return Make(kRenderPoint, point, 0); }
constexpr SurfaceId OfRenderEdge(size_t edge, size_t side) { return Make(kRenderEdge, edge, side); }
constexpr SurfaceId OfRenderMiddle(size_t triangle, size_t first) {
  return Make(kRenderMiddle, triangle, first);
}
constexpr SurfaceId OfLoosePair(size_t pair, size_t side) { return Make(kLoosePair, pair, side); }
constexpr SurfaceId OfLooseTriple(size_t triple, size_t first) {
  return Make(kLooseTriple, triple, first);
}
// Where gaps between a render mesh and the body are closed, on the side of node `first` of those.
constexpr SurfaceId OfRenderApex(size_t first) { return Make(kRenderApex, first, 0); }

// Triangles. Of a boundary face, 4 * tet + face: `corners` has bit i for corner i, 3 + i for the
// middle between corner i and the next, 6 for the face point.
constexpr SurfaceId OfOuter(size_t face, unsigned corners) { return Make(kOuter, face, corners); }
// Inside a split tet: across its edge k towards the edge's end `side`; in the half at either of the
// faces that meet there, whole (0), or parted by a pinch point into outer (1) and inner (2).
constexpr SurfaceId OfCrack(size_t tet, size_t k, size_t side, size_t half, size_t share) {
  return Make(kCrack, tet, k << 4 | side << 3 | half << 2 | share);
}
// Of a render mesh's triangle: `corners` as above, with cuts for middles. And the crack inwards
// from its edge k (3: from the cut across it) on the side of corner `side`, in the half at the cut
// (0) or further in (1).
constexpr SurfaceId OfRenderOuter(size_t triangle, unsigned corners) {
  return Make(kRenderOuter, triangle, corners);
}
constexpr SurfaceId OfRenderCrack(size_t triangle, size_t k, size_t side, size_t half) {
  return Make(kRenderCrack, triangle, k << 3 | side << 1 | half);
}
// Of what closes a gap, across its edge k on the side of corner `side`.
constexpr SurfaceId OfRenderCap(size_t gap, size_t k, size_t side, size_t turn) {
  return Make(kRenderCap, gap, turn << 4 | k << 2 | side);
}

}  // namespace surface_id
}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_SURFACE_IDS_H_

#ifndef CLEAVE_TESTS_METRICS_CRACK_SURFACE_H_
#define CLEAVE_TESTS_METRICS_CRACK_SURFACE_H_

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

// Where a body cracked and which way, in its rest shape.

namespace cleave {

// One side of a flat part of a crack inside one tet.
struct CrackFacet {
  Vec3 center{0, 0, 0};  // m
  Vec3 normal{0, 0, 0};  // unit; the sign means nothing
  double area = 0;       // m^2, half the polygon's: the other side has the rest
  int32_t tet = 0;
  int32_t node = 0;  // one of the tet's nodes on this side
};

// The polygons through the midpoints of broken edges round each group of vertices in every tet
// whose unbroken edges no longer join its vertices: the crack without the staircase of corner
// cells. Precondition: edge ids are in range.
std::vector<CrackFacet> CrackSurface(const TetMesh& mesh, const Incidence& incidence,
                                     std::span<const int32_t> broken_edges);

// The sides that belong to pieces worth counting (PiecesOf): without the skins of dust.
std::vector<CrackFacet> CrackOfPieces(const TetMesh& mesh, const Incidence& incidence,
                                      std::span<const int32_t> broken_edges);

// The same facets, each with the principal direction of the normals within `radius` (m) of it, by
// area. Single normals scatter by what the mesh offers, which alone makes A(a) of a crack along the
// fibres about 0.3; these are the crack that the eye sees.
std::vector<CrackFacet> SmoothedCrack(std::span<const CrackFacet> crack, double radius);

// The parts of a crack: facets whose centres a chain of steps of at most `reach` (m) joins. In the
// order of their first facets.
std::vector<std::vector<CrackFacet>> CrackParts(std::span<const CrackFacet> crack, double reach);

double CrackArea(std::span<const CrackFacet> crack);  // m^2

// A(a): the mean of |n.a| over the crack by area; 0 where the crack contains the direction, 1 where
// it crosses it. `direction` gives a unit vector for a tet. 0 for no crack.
double FibreCrossing(std::span<const CrackFacet> crack,
                     const std::function<Vec3(int32_t tet)>& direction);
double FibreCrossing(std::span<const CrackFacet> crack, const Vec3& direction);

// Of the facets' centres, m; 0 for no crack.
Vec3 CrackCenter(std::span<const CrackFacet> crack);

// The area-weighted `share` percentile of |x - p|.n over the crack, m; the crack is not empty.
double DistanceFromPlane(std::span<const CrackFacet> crack, const Vec3& point, const Vec3& normal,
                         double share);

// The smallest and largest coordinate along `axis` that hold all but `tail` of the area at each
// end, m. Precondition: the crack is not empty.
struct CrackExtent {
  double low = 0;
  double high = 0;
  double length() const { return high - low; }
};
CrackExtent ExtentAlong(std::span<const CrackFacet> crack, const Vec3& axis, double tail);

// The line that a crack through a plate draws on the plane square to `normal`: for every facet the
// principal direction of the crack within `radius` (m) of it, weighted by area. What a single facet
// turns by follows the mesh; this is what the eye sees. Facets whose surroundings have no direction
// (fewer than three facets) get 0.
std::vector<Vec3> TraceDirections(std::span<const CrackFacet> crack, const Vec3& normal,
                                  double radius);

// The area-weighted median of the angle between trace and direction, degrees in [0, 90]; 90 for no
// trace.
double TraceAngle(std::span<const CrackFacet> crack, const Vec3& normal, double radius,
                  const Vec3& direction);

}  // namespace cleave

#endif  // CLEAVE_TESTS_METRICS_CRACK_SURFACE_H_

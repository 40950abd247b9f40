#ifndef CLEAVE_TESTS_SCENES_SCENE_PARTS_H_
#define CLEAVE_TESTS_SCENES_SCENE_PARTS_H_

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "tests/scenes/demonstration.h"

// What demonstrations are put together from.

namespace cleave {

// Nodes, or tets by their centroids, whose rest position (m) meets a condition; ascending ids.
using Place = std::function<bool(const Vec3&)>;
std::vector<int32_t> NodesWhere(const TetMesh& mesh, const Place& holds);
std::vector<uint8_t> NodeFlags(const TetMesh& mesh, const Place& holds);
Vec3 Centroid(const TetMesh& mesh, size_t tet);  // m

// Makes the tets whose centroid meets the condition a region of that id and name.
void NameRegion(TetMesh& mesh, int32_t id, const std::string& name, const Place& holds);

void AddNodeSet(Scene& scene, const std::string& name, const std::vector<int32_t>& nodes);

// Prescribes all or some axes of a set, pinned until keyframes are added. Returns its index.
size_t AddMotion(Scene& scene, const std::string& set,
                 std::array<bool, 3> axes = {true, true, true},
                 std::vector<Keyframe> keyframes = {});

// Names the nodes within `grip` (m) of either end of a body of that length (m) along x with its
// middle at the origin: grip and pulled of `made`, node sets "left end" and "right end".
void GripEnds(Demonstration& made, double length, double grip);
// Doubles the strength of edges within `reach` (m) of x = `place` and x = -`place`, so that grips
// do not start the cracks.
void Reinforce(Scene& scene, double place, double reach);

// From rest to `translation` (m) over `seconds`.
std::vector<Keyframe> PullBy(const Vec3& translation, double seconds);

// `frames` of one step each over `seconds`, solved no tighter than criteria notice.
void SetPace(Scene& scene, double seconds, int64_t frames);

// The map's values dealt out to other nodes at random: the control that a map must beat.
std::vector<uint8_t> Shuffled(std::vector<uint8_t> flags, uint32_t seed);
// Such flags as a potency map.
std::vector<double> MapOf(const std::vector<uint8_t>& flags);

// Nodes that the scene's impurities give at least half of the largest potency. Precondition: the
// scene has impurities that fit the mesh.
std::vector<uint8_t> ImpureNodes(const Scene& scene, const TetMesh& mesh);

// Nodes at the ends of edges that the scene's layers mark, besides those that ImpureNodes gives.
// Precondition as above.
std::vector<uint8_t> MarkedNodes(const Scene& scene, const TetMesh& mesh);

// The control of a scene whose layers all do the same: what they do to those nodes, and to the edges
// between them, dealt out to as many others.
void DealOut(Scene& scene, const std::vector<uint8_t>& nodes, uint32_t seed);

// Unit vector in the x-y plane, `degrees` from x towards y.
Vec3 InPlane(double degrees);

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SCENE_PARTS_H_

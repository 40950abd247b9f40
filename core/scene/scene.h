#ifndef CLEAVE_CORE_SCENE_SCENE_H_
#define CLEAVE_CORE_SCENE_SCENE_H_

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/procedural_shapes.h"
#include "core/scene/impurities.h"  // IWYU pragma: export
#include "core/scene/polyline.h"    // IWYU pragma: export

// What a client asks for, as plain data in SI units. Every struct mirrors the message of the same
// name in proto/cleave/v1/scene.proto, field names included, so that a fault's path is the same in
// a scene file, in a request and here. Optional things are std::optional or empty vectors; a scene
// pays for nothing that it does not hold.

namespace cleave {

// A file beside the scene file. Only clients know it: they upload it and send a MeshAsset.
struct MeshFile {
  std::string path;
};

// A mesh that the server holds, named by content.
struct MeshAsset {
  std::string sha256;  // 64 lower-case hex digits
};

struct MeshSource {
  std::variant<std::monostate, MeshFile, MeshAsset, BoxMesh, CylinderMesh, TubeMesh, DiscMesh>
      source;
  double unit_scale = 1;  // metres for one unit of the mesh's coordinates
};

// How an isotropic solid answers strain (method note, section 5).
enum class ElasticLaw {
  kStableNeoHookean,
  kInvertibleNeoHookean,
  kCorotatedLinear,
  kStVenantKirchhoff,
};

// The same direction everywhere.
struct ConstantDirection {
  Vec3 vector{0, 0, 0};  // any length but 0
};
// A fixed mixture of the three directions of the cylindrical frame of an axis: away from it, around
// it and along it. On the axis itself, which has no outward direction, any will do.
struct CylindricalDirection {
  Vec3 center{0, 0, 0};   // m, a point of the axis
  Vec3 axis{0, 0, 1};     // any length but 0
  Vec3 mixture{0, 0, 1};  // outward, around, along; any length but 0
};
// A direction for every tet of the mesh, in its order.
struct TetDirections {
  std::vector<Vec3> vectors;  // any length but 0
};
// The directions of curves nearby: the mean over their segments, weighted by the inverse fourth
// power of distance; a curve and its reverse are the same.
struct CurveDirections {
  std::vector<Polyline> curves;
};
using FibreDirection = std::variant<std::monostate, ConstantDirection, CylindricalDirection,
                                    TetDirections, CurveDirections>;

// Fibres in a material, which resist changes of their length (method note, section 5).
struct FibreFamily {
  double stiffness = 0;  // Pa, what Young's modulus along the fibre gains
  FibreDirection direction;
  double strength_ratio = 1;  // edges along the fibre are this much stronger than those across
};

// How a ductile solid flows once it yields (method note, section 6): at constant volume, with
// isotropic hardening.
struct Plasticity {
  double yield_stress = 0;  // Pa, of von Mises
  double hardening = 0;     // Pa, what yield stress gains with equivalent plastic strain
  // 1/s: overstress decays as exp(-flow_rate t); infinite: at once.
  double flow_rate = std::numeric_limits<double>::infinity();
  // Equivalent plastic strain at which edges break, below their strength too; absent: none.
  std::optional<double> failure_strain = std::nullopt;
};

// How strength falls with load cycles (beyond the paper): Basquin's law sigma_a = sigma_f' (2
// N_f)^b for the amplitude that breaks after N_f reversed cycles, shares of life added up after
// Miner. In compression the same shares of the compressive strength count as much; without one,
// cycles in compression do nothing.
struct Fatigue {
  double strength_coefficient = 0;        // sigma_f', Pa
  double strength_exponent = 0;           // b < 0; of metals about -0.05 to -0.12
  std::optional<double> endurance_limit;  // Pa, amplitude up to which cycles do nothing
  // nu: strength falls with this power of the share of life that is over, to the load's peak at
  // the end; a large one keeps it to the last.
  double degradation_exponent = 1;
};

// How a torn solid goes on holding by strings. A tet that its broken edges or a hinge would kill is
// left with `residual_factor` of the energy of its unbroken edges alone, until one of them is
// longer than `stretch_limit` times rest length. No force crosses a cut, and pieces are as before
// what unbroken edges join. Elastic materials only.
struct Strands {
  double residual_factor = 0;  // [0.001, 1), which no other damage takes a tet below
  double stretch_limit = 0;    // > 1
};

// A material and the regions that it fills. Later materials win where regions overlap.
struct Material {
  std::string name;
  std::vector<std::string> regions;  // names or decimal ids; empty: every region
  ElasticLaw law = ElasticLaw::kStableNeoHookean;
  double youngs_modulus = 0;  // Pa
  double poisson_ratio = 0;
  double density = 0;                      // kg/m^3
  std::optional<double> tensile_strength;  // Pa, threshold of edge stress; absent: never breaks
  // Pa, threshold of compressive edge stress; absent: compression never breaks.
  std::optional<double> compressive_strength;
  std::vector<FibreFamily> fibres;
  std::optional<Plasticity> plasticity;  // absent: elastic until it breaks
  std::optional<Fatigue> fatigue;        // absent: load cycles do not weaken it
  std::optional<Strands> strands;        // absent: what is torn lets go at once
};

struct BoxSelector {
  Vec3 min{0, 0, 0};
  Vec3 max{0, 0, 0};
};
struct SphereSelector {
  Vec3 center{0, 0, 0};
  double radius = 0;
};
// Nodes on the side that the normal points to, the plane itself included.
struct PlaneSelector {
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 0, 0};  // any length but 0
};
struct RegionSelector {
  std::string region;  // a name or a decimal id
};
struct IdSelector {
  std::vector<int64_t> ids;
};
using Selector = std::variant<std::monostate, BoxSelector, SphereSelector, PlaneSelector,
                              RegionSelector, IdSelector>;

// Nodes chosen by their rest positions (m, after unit_scale): all that any selector chooses.
struct NodeSet {
  std::string name;
  std::vector<Selector> select;
};

// Where a moving node set is at a time. Between keyframes motion is linear in time; before the
// first and after the last it stands still.
struct Keyframe {
  double time = 0;            // s
  Vec3 translation{0, 0, 0};  // m, from rest
  double rotation = 0;        // rad about the motion's axis, before the translation
};

// When a motion or load ends for good: with the first step that begins when any of these holds.
// Nodes that a motion lets go keep the velocity that they had. Edges cut before the first step are
// not broken by it.
struct Release {
  std::optional<double> time = std::nullopt;          // s, at or after
  bool first_fracture = false;                        // an edge has broken
  std::optional<double> broken_share = std::nullopt;  // at least this share of all edges has broken
  // The body is in at least so many; lone nodes do not count.
  std::optional<int32_t> pieces = std::nullopt;
  std::vector<std::string> separated_node_sets = {};  // no piece holds nodes of two of these
};

// Prescribes the motion of a node set; without keyframes it pins the set where it rests. A line of
// pinned nodes is a hinge: the body is free to turn about it.
struct Motion {
  std::string node_set;
  std::array<bool, 3> axes{true, true,
                           true};   // which of x, y, z are prescribed; the rest move freely
  std::vector<Keyframe> keyframes;  // by ascending time
  Vec3 rotation_center{0, 0, 0};    // m
  Vec3 rotation_axis{0, 0, 1};      // any length but 0
  std::optional<Release> release;   // absent: never
};

// A force that the nodes of the set share evenly. A node that no live tet is left at takes its
// share with it.
struct PointForce {
  Vec3 total{0, 0, 0};  // N
};
// A force per rest area on boundary faces, in a fixed direction.
struct SurfaceTraction {
  Vec3 traction{0, 0, 0};  // Pa
};
// A force per current area on boundary faces that follows their normals and pushes on the body
// where it is positive.
struct SurfacePressure {
  double pressure = 0;  // Pa
};
using LoadKind = std::variant<std::monostate, PointForce, SurfaceTraction, SurfacePressure>;

// How strong a load is at a time. Linear between keyframes, as the first before it and as the last
// after it.
struct LoadKeyframe {
  double time = 0;       // s
  double intensity = 1;  // times the load
};

// A load on a node set; of tractions and pressures, on the faces of the mesh's boundary with all
// three nodes in it, for as long as their tets live. Cracks do not open faces to loads.
struct Load {
  std::string node_set;
  LoadKind kind;
  std::vector<LoadKeyframe> keyframes;  // by ascending time; empty: full strength throughout
  std::optional<Release> release;       // absent: never
};

// Velocity of nodes at the start.
struct InitialVelocity {
  std::string node_set;            // empty: every node
  Vec3 velocity{0, 0, 0};          // m/s
  Vec3 angular_velocity{0, 0, 0};  // rad/s about `center`
  Vec3 center{0, 0, 0};            // m
};

// Everything on the side that the normal points away from.
struct PlaneShape {
  Vec3 point{0, 0, 0};   // m
  Vec3 normal{0, 0, 1};  // any length but 0
};
struct SphereShape {
  Vec3 center{0, 0, 0};  // m
  double radius = 0;     // m
};
// A box, turned about its centre.
struct BoxShape {
  Vec3 center{0, 0, 0};         // m
  Vec3 size{0, 0, 0};           // m, whole edges
  Vec3 rotation_axis{0, 0, 1};  // any length but 0
  double rotation = 0;          // rad
};
// A closed surface of triangles that turn counterclockwise seen from outside.
struct SurfaceShape {
  std::vector<Vec3> vertices;                     // m
  std::vector<std::array<int32_t, 3>> triangles;  // of vertices, from 0
  // A file beside the scene file, in place of both. Clients read it; a scene to be run has none.
  std::string file = {};
};
using Shape = std::variant<std::monostate, PlaneShape, SphereShape, BoxShape, SurfaceShape>;

// What a collider weighs and how it flies at the start. Exactly one of mass and density is given;
// mass is spread evenly over the shape.
struct RigidBody {
  std::optional<double> mass;      // kg
  std::optional<double> density;   // kg/m^3
  Vec3 velocity{0, 0, 0};          // m/s
  Vec3 angular_velocity{0, 0, 0};  // rad/s, about the centre of mass
};

// A rigid thing that nodes cannot enter (method note, section 9). It rests, follows keyframes, or
// is a body that moves under gravity and is pushed back. Colliders do not see each other.
struct Collider {
  std::string name;
  Shape shape;
  std::vector<Keyframe> keyframes;  // by ascending time; from where the shape is
  Vec3 rotation_center{0, 0, 0};    // m
  Vec3 rotation_axis{0, 0, 1};      // any length but 0
  std::optional<RigidBody> body;
  double friction = 0;  // Coulomb's coefficient
  double stiffness =
      5;              // of the contact: this times Young's modulus times the mean edge, N/m a node
  double margin = 0;  // m, that nodes keep from the shape
};

// Contact between pieces that have separated (method note, section 9).
struct Contact {
  double stiffness = 5;  // as of a collider
  double friction = 0;   // Coulomb's coefficient
};

// When pieces at rest are no longer calculated, until something touches them. At rest is what stays
// slower than `speed` in the scene's coordinates for `time`, while the forces on it balance and no
// tet flows; what creeps so slowly stops. The kinetic energy that this takes out counts as
// dissipated by integration.
struct Sleep {
  double speed = 1e-3;  // m/s, of the fastest node
  double time = 0.25;   // s
};

// Which stress breaks edges of a material with fibres.
enum class FractureStress {
  kMatrix,  // that of the isotropic solid, so that cracks follow the fibres
  kTotal,
};

// How an edge's stress follows from the stresses of its live tets.
enum class StressAggregation {
  kMean,  // weighted by rest volume; slivers do not break edges by themselves
  kMax,
};

// What broken edges leave of a tet that still hangs together.
enum class Reformulation {
  kUniform,        // Eq. 2: all of its stress times the share that its unbroken edges carried
  kEdgeProjected,  // an energy of the strains of its unbroken edges; for elastic materials
};

// Edges by their nodes: both ends are in the set.
struct EdgesOfNodes {
  std::string node_set;
};
// Edges by what they touch: any point of them is in the box or sphere.
using EdgeSelector = std::variant<std::monostate, EdgesOfNodes, BoxSelector, SphereSelector>;

// Weakens or strengthens edges: their threshold counts `factor` times. 0 cuts them before the first
// step, in any material; infinity makes them unbreakable.
struct Weakening {
  EdgeSelector edges;
  double factor = 1;  // w, [0, infinity]
};

// How fracture is staged within a step (method note, section 7). Used only where some material has
// a strength.
struct Fracture {
  int32_t max_passes = 60;    // break-and-solve passes a step
  double simultaneity = 0.9;  // edges at this share of the worst failure ratio break with it
  FractureStress stress = FractureStress::kMatrix;
  StressAggregation aggregation = StressAggregation::kMean;
  Reformulation reformulation = Reformulation::kUniform;
};

struct Timing {
  double frames_per_second = 24;
  int64_t frame_count = 48;
  int32_t steps_per_frame = 4;
};

// Rayleigh damping of the body: forces -(a M + b K) v of its mass M and its elastic stiffness K,
// that of the start of the step without negative eigenvalues, as it has yielded and broken so far
// (method note, section 7). A vibration of angular frequency w decays at the damping ratio
// a / (2 w) + b w / 2, besides what backward Euler takes. b takes what deforms, and nothing of
// what a piece moves and turns as a whole; a drags the body against the scene's coordinates. What
// breaks edges is the elastic stress alone.
struct Damping {
  double mass_coefficient = 0;       // a, 1/s
  double stiffness_coefficient = 0;  // b, s
};

// In what elements and linear solves calculate. Displacements, velocities, nodal forces, sums of
// energies and what the solver decides by them are double in either.
enum class Precision {
  kDouble,
  kFloat,  // faster; stresses err by about 1e-7 of the moduli
};

// The trade of speed against accuracy (method note, sections 7 and 10).
struct Quality {
  int32_t newton_iterations = 8;  // most a solve may take before the step is halved
  double residual_tolerance =
      1e-4;                      // force residual relative to inertial + elastic + external forces
  double step_tolerance = 1e-4;  // last Newton step relative to the mean edge length
  double linear_tolerance = 1e-3;  // relative residual of each linear solve
  int32_t max_step_halvings = 6;
  Precision precision = Precision::kDouble;
};

// A fine triangle mesh round the body, which those who show it draw in place of its surface. The
// simulation knows nothing of it: the same scene without one has the same bits.
struct RenderMeshSource {
  std::variant<std::monostate, MeshFile, MeshAsset> source;
  double unit_scale = 1;  // metres for one unit of its coordinates
};

struct Output {
  // m, largest error of a streamed coordinate; 0: every bit is kept; absent: 1e-4 of the diagonal.
  std::optional<double> tolerance;
  int32_t keyframe_interval = 24;    // frames
  int32_t checkpoint_interval = 10;  // frames
};

struct Scene {
  std::string name;
  MeshSource mesh;
  std::vector<Material> materials;
  std::vector<NodeSet> node_sets;
  std::vector<Motion> motions;
  std::vector<Load> loads;
  std::vector<InitialVelocity> initial_velocities;
  std::optional<Vec3> gravity;  // m/s^2
  Fracture fracture;
  std::vector<Weakening> weakenings;  // later ones win
  std::optional<Impurities> impurities;
  std::vector<Collider> colliders;
  std::optional<Contact> contact;               // absent: pieces pass through each other
  std::optional<Sleep> sleep;                   // absent: nothing sleeps
  std::optional<RenderMeshSource> render_mesh;  // absent: the body's own surface is shown
  Timing timing;
  std::optional<Damping> damping;  // absent: backward Euler's alone
  Quality quality;
  Output output;
  uint32_t seed = 0;
};

// Whether anything damps motion besides backward Euler.
inline bool IsDamped(const Scene& scene) {
  return scene.damping.has_value() &&
         (scene.damping->mass_coefficient > 0 || scene.damping->stiffness_coefficient > 0);
}

// Whether load cycles weaken anything.
inline bool Tires(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.fatigue.has_value()) return true;
  }
  return false;
}

// Whether anything torn holds on by strands.
inline bool PullsStrands(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.strands.has_value()) return true;
  }
  return false;
}

// Whether anything in the scene changes what thresholds of edges count, but for impurities'
// potency.
inline bool WeakensEdges(const Scene& scene) {
  return !scene.weakenings.empty() ||
         (scene.impurities.has_value() && WeakensEdges(*scene.impurities));
}

// Whether anything in the scene can break or is cut.
inline bool CanBreak(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.tensile_strength.has_value() || material.compressive_strength.has_value())
      return true;
  }
  return WeakensEdges(scene);
}

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_SCENE_H_

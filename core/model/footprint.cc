#include "core/model/footprint.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/vec3.h"
#include "core/damage/edge_mask.h"
#include "core/damage/fatigue.h"
#include "core/damage/named_pieces.h"
#include "core/model/collider_term.h"
#include "core/model/edge_projected_term.h"
#include "core/model/elastic_term.h"
#include "core/model/fragment_contact.h"
#include "core/model/load_terms.h"
#include "core/model/nodal_vector.h"
#include "core/model/plastic_term.h"

namespace cleave {
namespace {

constexpr int64_t kInt = sizeof(int32_t);
constexpr int64_t kDouble = sizeof(double);
constexpr int64_t kVec3 = sizeof(Vec3);
constexpr int64_t kNodal = sizeof(Double4);
constexpr int64_t kMostLanes = 8;

// Measured by tests/bench on an EPYC core at 2.6 GHz, s and iterations.
constexpr double kNewtonSecondsPerTet = 0.2e-6;    // forces, stiffness and preconditioner
constexpr double kLinearSecondsPerEdge = 4e-9;     // an iteration
constexpr double kFractureSecondsPerTet = 0.1e-6;  // a pass
constexpr double kNewtonPerStep = 2;
// While it breaks, a body takes tens of solves a step; over a run that comes to about this factor.
constexpr double kBreakingFactor = 3;

}  // namespace

Footprint PlanModel(const Scene& scene, int64_t nodes, int64_t tets, int64_t edges) {
  Footprint footprint;
  const auto add = [&](const char* name, int64_t bytes) {
    footprint.parts.push_back({name, bytes});
    footprint.total_bytes += bytes;
  };

  // Every scene.
  add("mesh", nodes * kVec3 + tets * 4 * kInt + 2 * (nodes + tets) * kInt);
  add("incidence", edges * 2 * kInt + tets * 6 * kInt +  // edges, edges of tets
                       (nodes + 1 + 2 * edges) * kInt +  // edges of nodes
                       (nodes + 1 + 4 * tets) * kInt +   // tets of nodes
                       (edges + 1 + 6 * tets) * kInt);   // tets of edges
  const bool uniform = scene.materials.size() <= 1;
  const Precision precision = scene.quality.precision;
  std::set<std::tuple<ElasticLaw, size_t, bool>> kinds;  // of elastic terms, as in BuildModel
  size_t families = 0;
  bool flows = false;
  for (const Material& material : scene.materials) {
    size_t stiff = 0;
    for (const FibreFamily& family : material.fibres) stiff += family.stiffness > 0;
    const bool ductile = material.plasticity.has_value();
    kinds.insert({material.law, stiff, ductile});
    flows = flows || ductile;
    families = std::max(families, stiff);
  }
  // The last batch of each kind may be part empty.
  const auto more_kinds = static_cast<int64_t>(std::max<size_t>(kinds.size(), 1)) - 1;
  const int64_t elastic_tets = tets + more_kinds * kMostLanes;
  add("elasticity",
      ElasticTermBytes(precision, elastic_tets, uniform) + (more_kinds > 0 ? tets * kInt : 0));
  add("state", nodes * (kDouble + 4 * kNodal + kVec3));  // masses, now and before, positions
  const int64_t matrix_bytes = 18 * (edges + 1) * static_cast<int64_t>(sizeof(float)) +
                               2 * (nodes + 1) * kInt + 3 * edges * kInt;
  add("stiffness matrix", matrix_bytes);
  // In float the vectors of linear solves take half, but there is one more.
  add("solver",
      nodes * (24 - (precision == Precision::kFloat ? 3 : 0)) * kNodal / 2 + nodes * kDouble);

  // What the scene adds.
  if (scene.gravity) add("gravity", 0);
  if (IsDamped(scene)) {
    // Rates, matrix diagonal, forces; rigid steps and their pieces, as if every node were one.
    const int64_t of_stiffness = matrix_bytes + nodes * (kInt + 8 * kNodal);
    add("damping", nodes * (2 * kDouble + 2 * kNodal) +
                       (scene.damping->stiffness_coefficient > 0 ? of_stiffness : 0));
  }
  if (!scene.motions.empty()) {
    int64_t bytes = nodes * 2 * kNodal;
    for (const Motion& motion : scene.motions)
      bytes += nodes * kInt + static_cast<int64_t>(motion.keyframes.size()) *
                                  static_cast<int64_t>(sizeof(Keyframe));
    add("motions", bytes);
  }
  if (!scene.loads.empty()) {
    int64_t bytes = nodes * kNodal;  // their forces
    for (const Load& load : scene.loads) {
      bytes += LoadTermBytes(load, nodes) + static_cast<int64_t>(load.keyframes.size()) *
                                                static_cast<int64_t>(sizeof(LoadKeyframe));
    }
    add("loads", bytes);
  }
  if (!scene.initial_velocities.empty()) add("initial velocities", 0);
  if (!scene.colliders.empty()) {
    int64_t bytes = nodes * ColliderTerm::BytesPerNode() + (uniform ? 1 : nodes) * kDouble;
    for (const Collider& collider : scene.colliders) {
      const auto* surface = std::get_if<SurfaceShape>(&collider.shape);
      bytes += ColliderTerm::BytesOf(collider.keyframes.size(),
                                     surface != nullptr ? surface->triangles.size() : 0);
    }
    add("colliders", bytes);
  }
  int64_t release_bytes = 0;
  const auto add_release = [&](const std::optional<Release>& release) {
    if (!release) return;
    // What fracture has come to is kept once, the named sets each.
    if (release_bytes == 0) release_bytes = nodes * kInt;
    release_bytes += static_cast<int64_t>(release->separated_node_sets.size()) * nodes * kInt;
  };
  for (const Motion& motion : scene.motions) add_release(motion.release);
  for (const Load& load : scene.loads) add_release(load.release);
  if (release_bytes > 0) add("releases", release_bytes);
  const bool breaks = CanBreak(scene);
  if (scene.contact)
    add("contact", FragmentContact::BytesOf(nodes, edges) + (uniform ? 1 : nodes) * kDouble);
  if (scene.sleep) {
    // Where every node is a piece: labels and groups, quiet seconds, sums over pieces; what is held
    // where motions hold it; which tets are left out.
    const int64_t of_node = 2 * kInt + kDouble + 3 + 7 * kNodal / 2;
    add("sleep", nodes * (of_node + (scene.motions.empty() ? 0 : kNodal)) + tets);
  }
  bool directional = false;
  for (const Material& material : scene.materials) {
    for (const FibreFamily& family : material.fibres)
      directional = directional || family.strength_ratio > 1;
  }
  if (families > 0) {
    add("fibres", static_cast<int64_t>(families) * FibreFamilyBytes(precision, elastic_tets));
  }
  if (flows) {
    add("plasticity", PlasticBytes(precision, elastic_tets, uniform) +
                          (breaks ? tets * static_cast<int64_t>(sizeof(PlasticTet)) + tets * kInt
                                  : 0));  // as fracture sees it
  }
  if (breaks) {
    add("fracture",
        (uniform && !directional && !WeakensEdges(scene) ? 1 : edges) * kDouble +
            edges * kInt +                                                       // thresholds, ids
            tets * (3 * kDouble + 1 + static_cast<int64_t>(sizeof(EdgeMask))) +  // damage
            edges * (1 + kDouble) + nodes * kInt +                               // edges, pieces
            NamedPieces::BytesOf(nodes, edges) + nodes * kVec3 +
            tets * static_cast<int64_t>(sizeof(Eigen::Matrix3d)));  // stresses
  }

  const bool crushes = std::any_of(
      scene.materials.begin(), scene.materials.end(),
      [](const Material& material) { return material.compressive_strength.has_value(); });
  if (crushes) add("compressive strength", (uniform && !WeakensEdges(scene) ? 1 : edges) * kDouble);
  const bool projects = breaks && scene.fracture.reformulation == Reformulation::kEdgeProjected;
  const int64_t projected_bytes = tets * EdgeProjectedTerm::TetBytes();  // at most
  if (projects) add("edge-projected tets", projected_bytes);
  if (PullsStrands(scene)) {
    add("strands", (projects ? 0 : projected_bytes) +
                       (uniform ? 0 : tets * static_cast<int64_t>(sizeof(int16_t))) +
                       tets * kDouble);  // factors as loads see them
  }
  if (Tires(scene)) {
    add("fatigue", FatigueDamage::BytesOf(edges) + edges * kDouble +  // stresses
                       (uniform ? 0 : edges * static_cast<int64_t>(sizeof(int16_t))));
  }
  if (breaks && scene.impurities && scene.impurities->model != ImpurityModel::kOff) {
    const Impurities& impurities = *scene.impurities;
    add("impurities",
        nodes * kDouble + edges * kDouble +  // potencies, thresholds
            (impurities.model == ImpurityModel::kGraph ? nodes * kInt : 0) +         // degrees
            (impurities.mode == ImpurityMode::kSampled ? edges * kDouble : 0) +      // draws
            (impurities.model == ImpurityModel::kUncorrelated ? edges * kInt : 0));  // deal
  }

  // A linear solve carries a push through the mesh: its iterations grow with the nodes across.
  const double across = std::cbrt(static_cast<double>(nodes));
  const double linear_iterations =
      across * std::max(1.0, 3 - 0.45 * std::log10(scene.quality.linear_tolerance));
  const double newton_iterations =
      std::min(kNewtonPerStep, static_cast<double>(scene.quality.newton_iterations));
  const double solve =
      newton_iterations * (kNewtonSecondsPerTet * static_cast<double>(tets) +
                           linear_iterations * kLinearSecondsPerEdge * static_cast<double>(edges));
  const double step =
      breaks ? kBreakingFactor * (solve + kFractureSecondsPerTet * static_cast<double>(tets))
             : solve;
  footprint.seconds_per_frame = step * scene.timing.steps_per_frame;
  footprint.total_seconds =
      footprint.seconds_per_frame * static_cast<double>(scene.timing.frame_count);
  return footprint;
}

}  // namespace cleave

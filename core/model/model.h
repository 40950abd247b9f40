#ifndef CLEAVE_CORE_MODEL_MODEL_H_
#define CLEAVE_CORE_MODEL_MODEL_H_

#include <memory>
#include <optional>
#include <vector>

#include "core/base/vec3.h"
#include "core/damage/fatigue.h"
#include "core/damage/fracture.h"
#include "core/damage/random_graph.h"
#include "core/damage/strands.h"
#include "core/mesh/incidence.h"
#include "core/mesh/reorder.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/edge_projected_term.h"
#include "core/model/nodal_vector.h"
#include "core/model/node_term.h"
#include "core/model/plastic_term.h"
#include "core/model/prescribed_motion.h"
#include "core/model/release.h"
#include "core/model/tet_term.h"
#include "core/scene/scene.h"

namespace cleave {

// What impurities add to a body that can break.
struct ImpurityPart {
  RandomGraphSettings settings;
  std::vector<double> potencies;   // a node each
  std::vector<double> edge_draws;  // an edge each, where strengths are drawn
  std::vector<int32_t> edge_deal;  // an edge each, where strengths are dealt out: whose it has
};

// What a body that tires has besides.
struct FatiguePart {
  std::vector<FatigueLaw> laws;
  std::vector<int16_t> edge_laws;  // of an edge each, -1 for none; empty: the first for all
};

// What a body that pulls strands has besides.
struct StrandPart {
  std::vector<StrandLaw> laws;
  std::vector<int16_t> tet_laws;  // of a tet each, -1 for none; empty: the first for all
};

// What a body that can break has besides.
struct FracturePart {
  std::vector<double> edge_thresholds;  // Pa, of tension, an edge each, or one for all
  // Pa, of compression, the same; empty where no compression breaks.
  std::vector<double> compressive_thresholds;
  FractureSettings settings;
  int32_t max_passes = 60;           // of breaking and solving again, in a step
  std::vector<int32_t> client_edge;  // the client's id of every edge
  // Which of the tet terms takes over damaged tets where they are edge-projected, and strands.
  EdgeProjectedTerm* edge_projected = nullptr;
  std::optional<ImpurityPart> impurities;
  std::optional<FatiguePart> fatigue;
  std::optional<StrandPart> strands;
};

class ColliderTerm;

// What a scene becomes: just the parts that it asks for. Ids in it are the solver's, nodes and tets
// in an order that is good for memory; `order` leads back. Does not change but for what
// its terms carry from step to step.
struct Model {
  // On the heap: terms point to it, and a model may move.
  std::unique_ptr<const TetMesh> mesh;  // m
  MeshOrder order;                      // old ids are the client's
  std::unique_ptr<const Incidence> incidence;
  double mean_edge_length = 0;  // m
  // kg, a node each; 0 for a node of no tet, which rests. Then those of unknowns that are no nodes:
  // two of each moving collider.
  std::vector<double> masses;
  std::vector<std::unique_ptr<TetTerm>> tet_terms;
  std::vector<PlasticTerm*> plastic_terms;  // those of tet_terms that flow
  bool fibrous = false;                     // whether fibres stiffen any tet
  std::vector<std::unique_ptr<NodeTerm>> node_terms;
  const ColliderTerm* colliders = nullptr;  // one of the node terms, where the scene has any
  std::optional<Vec3> gravity;              // m/s^2
  std::optional<Damping> damping;           // of the body, by a coefficient above 0
  std::vector<PrescribedMotion> motions;
  std::vector<ReleaseRule> releases;  // of motions and loads
  std::optional<FracturePart> fracture;
  std::optional<Sleep> sleep;
  Quality quality;

  int64_t node_count() const { return mesh->node_count(); }
  int64_t unknown_count() const { return static_cast<int64_t>(masses.size()); }
  int64_t tet_count() const { return mesh->tet_count(); }
};

// How the body is at an instant; a record an unknown.
struct State {
  NodalVector displacements;      // m, from rest
  NodalVector velocities;         // m/s
  std::vector<uint8_t> released;  // a rule of Model::releases each: 1 once it was due
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_MODEL_H_

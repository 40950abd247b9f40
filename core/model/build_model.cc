#include "core/model/build_model.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/damage/edge_thresholds.h"
#include "core/impurity/bake.h"
#include "core/material/fibre_directions.h"
#include "core/material/moduli.h"
#include "core/mesh/tet_geometry.h"
#include "core/model/collider_term.h"
#include "core/model/elastic_term.h"
#include "core/model/fragment_contact.h"
#include "core/model/impurities.h"
#include "core/model/load_terms.h"
#include "core/model/plastic_term.h"
#include "core/model/weakened_edges.h"
#include "core/scene/selection.h"

namespace cleave {
namespace {

// The solver's ids of a named node set, ascending; all nodes for the empty name.
std::vector<int32_t> NodesOf(const std::string& name, const Scene& scene, const TetMesh& mesh,
                             const MeshOrder& order) {
  std::vector<int32_t> nodes;
  for (const NodeSet& set : scene.node_sets) {
    if (!name.empty() && set.name == name) nodes = SelectNodes(set, mesh, RegionIndex(mesh));
  }
  if (name.empty()) {
    nodes.resize(static_cast<size_t>(mesh.node_count()));
    for (size_t node = 0; node < nodes.size(); ++node) nodes[node] = static_cast<int32_t>(node);
  }
  for (int32_t& node : nodes) node = order.new_node[static_cast<size_t>(node)];
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

// Adds the rule for `release`, if there is one; its place in Model::releases, or -1.
int32_t AddRelease(const std::optional<Release>& release, const Scene& scene, const TetMesh& mesh,
                   Model& model) {
  if (!release) return -1;
  ReleaseRule& rule = model.releases.emplace_back();
  rule.when = *release;
  for (const std::string& set : release->separated_node_sets)
    rule.separated.push_back(NodesOf(set, scene, mesh, model.order));
  return static_cast<int32_t>(model.releases.size()) - 1;
}

// How many families of fibres stiffen a material.
size_t StiffFamilies(const Material& material) {
  return static_cast<size_t>(
      std::count_if(material.fibres.begin(), material.fibres.end(),
                    [](const FibreFamily& family) { return family.stiffness > 0; }));
}

// What elastic passes are made for: tets of one kind share a term.
struct ElasticKind {
  ElasticLaw law;
  size_t families;  // of fibres
  bool ductile;
  auto operator<=>(const ElasticKind&) const = default;
};

ElasticKind KindOf(const Material& material) {
  return {material.law, StiffFamilies(material), material.plasticity.has_value()};
}

// The kinds of the materials, each once.
std::set<ElasticKind> KindsOf(const std::vector<Material>& materials) {
  std::set<ElasticKind> kinds;
  for (const Material& material : materials) kinds.insert(KindOf(material));
  return kinds;
}

// The tets whose material is of that kind, ascending.
std::vector<int32_t> TetsOf(const std::vector<Material>& materials,
                            const std::vector<int32_t>& material_of, const ElasticKind& kind) {
  std::vector<int32_t> tets;
  for (size_t tet = 0; tet < material_of.size(); ++tet) {
    if (KindOf(materials[static_cast<size_t>(material_of[tet])]) == kind)
      tets.push_back(static_cast<int32_t>(tet));
  }
  return tets;
}

// Elastic constants of the tets: one record where the scene has one material, else one each.
std::vector<LameConstants<double>> LameOf(const std::vector<Material>& materials,
                                          const std::vector<int32_t>& material_of,
                                          const std::vector<int32_t>& tets) {
  std::vector<LameConstants<double>> of_material;
  for (const Material& material : materials)
    of_material.push_back(ToLame(material.youngs_modulus, material.poisson_ratio));
  if (of_material.size() == 1) return of_material;
  std::vector<LameConstants<double>> of_tet;
  of_tet.reserve(tets.size());
  for (const int32_t tet : tets)
    of_tet.push_back(of_material[static_cast<size_t>(material_of[static_cast<size_t>(tet)])]);
  return of_tet;
}

// Yielding of ductile tets, as LameOf.
std::vector<Plasticity> PlasticityOf(const std::vector<Material>& materials,
                                     const std::vector<int32_t>& material_of,
                                     const std::vector<int32_t>& tets) {
  if (materials.size() == 1) return {*materials[0].plasticity};
  std::vector<Plasticity> of_tet;
  of_tet.reserve(tets.size());
  for (const int32_t tet : tets) {
    const auto material = static_cast<size_t>(material_of[static_cast<size_t>(tet)]);
    of_tet.push_back(*materials[material].plasticity);
  }
  return of_tet;
}

// Directions of all families of a material's fibres in its tets.
struct MaterialFibres {
  std::vector<int32_t> tets;                  // ascending
  std::vector<std::vector<Vec3>> directions;  // [family], a tet each
};

std::vector<MaterialFibres> FibresOf(const std::vector<Material>& materials,
                                     const std::vector<int32_t>& material_of, const TetMesh& mesh,
                                     const MeshOrder& order) {
  std::vector<MaterialFibres> fibres(materials.size());
  for (size_t tet = 0; tet < material_of.size(); ++tet) {
    const auto material = static_cast<size_t>(material_of[tet]);
    if (!materials[material].fibres.empty())
      fibres[material].tets.push_back(static_cast<int32_t>(tet));
  }
  for (size_t m = 0; m < materials.size(); ++m) {
    std::vector<int32_t> old_tets = fibres[m].tets;
    if (old_tets.empty()) continue;
    for (int32_t& tet : old_tets) tet = order.old_tet[static_cast<size_t>(tet)];
    for (const FibreFamily& family : materials[m].fibres)
      fibres[m].directions.push_back(FibreDirections(family.direction, mesh, old_tets));
  }
  return fibres;
}

// The k-th family that stiffens each of the tets, which all have as many.
FibreFamilyPart StiffFamily(const std::vector<Material>& materials,
                            const std::vector<int32_t>& material_of,
                            const std::vector<MaterialFibres>& fibres,
                            const std::vector<int32_t>& tets, size_t k) {
  FibreFamilyPart part;
  std::vector<size_t> next(materials.size(), 0);
  for (const int32_t tet : tets) {
    const auto m = static_cast<size_t>(material_of[static_cast<size_t>(tet)]);
    size_t family = 0;
    for (size_t stiff = 0;; ++family) {
      if (materials[m].fibres[family].stiffness > 0 && stiff++ == k) break;
    }
    part.directions.push_back(fibres[m].directions[family][next[m]++]);
    part.stiffness.push_back(materials[m].fibres[family].stiffness);
  }
  return part;
}

// What fibres do for the strength of edges.
std::vector<DirectionalStrength> DirectionalStrengths(const std::vector<Material>& materials,
                                                      const std::vector<MaterialFibres>& fibres) {
  std::vector<DirectionalStrength> strengths;
  size_t families = 0;
  for (const Material& material : materials) families = std::max(families, material.fibres.size());
  for (size_t k = 0; k < families; ++k) {
    for (size_t m = 0; m < materials.size(); ++m) {
      if (k >= fibres[m].directions.size() || materials[m].fibres[k].strength_ratio <= 1) continue;
      for (size_t i = 0; i < fibres[m].tets.size(); ++i) {
        strengths.push_back(
            {fibres[m].tets[i], fibres[m].directions[k][i], materials[m].fibres[k].strength_ratio});
      }
    }
  }
  return strengths;
}

double MeanEdgeLength(const TetMesh& mesh, const Incidence& incidence) {
  double sum = 0;
  for (const auto& [a, b] : incidence.edges) {
    const Double4 edge = ToDouble4(mesh.rest_positions[static_cast<size_t>(b)]) -
                         ToDouble4(mesh.rest_positions[static_cast<size_t>(a)]);
    sum += std::sqrt(Dot(edge, edge));
  }
  return sum / static_cast<double>(incidence.edges.size());
}

// Young's modulus times the mean edge, N/m: one where the scene has one material, else of the mean
// modulus round every node.
std::vector<double> NodeStiffness(const std::vector<Material>& materials,
                                  const std::vector<int32_t>& material_of, const Model& model) {
  if (materials.size() == 1) return {materials[0].youngs_modulus * model.mean_edge_length};
  std::vector<double> stiffness(model.masses.size(), 0), volumes(model.masses.size(), 0);
  for (size_t tet = 0; tet < material_of.size(); ++tet) {
    const double volume = SignedVolume(CornersOf(*model.mesh, static_cast<int64_t>(tet)));
    const double modulus = materials[static_cast<size_t>(material_of[tet])].youngs_modulus;
    for (const int32_t node : model.mesh->tets[tet]) {
      volumes[static_cast<size_t>(node)] += volume;
      stiffness[static_cast<size_t>(node)] += volume * modulus * model.mean_edge_length;
    }
  }
  for (size_t node = 0; node < stiffness.size(); ++node)
    stiffness[node] = volumes[node] > 0 ? stiffness[node] / volumes[node] : 0;
  return stiffness;
}

// How edges tire. An edge has the law of the material that its strength is of: the weakest of its
// tets', of equally weak ones that of the lowest tet.
FatiguePart FatigueOf(const std::vector<Material>& materials,
                      const std::vector<int32_t>& material_of, const Incidence& incidence) {
  FatiguePart part;
  std::vector<int16_t> law_of;  // a material each
  for (const Material& material : materials) {
    law_of.push_back(material.fatigue ? static_cast<int16_t>(part.laws.size()) : int16_t{-1});
    if (!material.fatigue) continue;
    const Fatigue& fatigue = *material.fatigue;
    const double strength = *material.tensile_strength;
    part.laws.push_back({fatigue.strength_coefficient / strength, -1 / fatigue.strength_exponent,
                         fatigue.endurance_limit.value_or(0) / strength,
                         fatigue.degradation_exponent});
  }
  if (materials.size() == 1) return part;
  std::vector<double> strengths(incidence.edges.size(), kUnbreakable);
  part.edge_laws.assign(incidence.edges.size(), -1);
  for (size_t tet = 0; tet < material_of.size(); ++tet) {
    const auto material = static_cast<size_t>(material_of[tet]);
    const double strength = materials[material].tensile_strength.value_or(kUnbreakable);
    for (const int32_t edge : incidence.tet_edges[tet]) {
      const auto e = static_cast<size_t>(edge);
      if (!(strength < strengths[e])) continue;
      strengths[e] = strength;
      part.edge_laws[e] = law_of[material];
    }
  }
  return part;
}

// How tets hold on as strands, each by the law of its material.
StrandPart StrandsOf(const std::vector<Material>& materials,
                     const std::vector<int32_t>& material_of) {
  StrandPart part;
  std::vector<int16_t> law_of;  // a material each
  for (const Material& material : materials) {
    law_of.push_back(material.strands ? static_cast<int16_t>(part.laws.size()) : int16_t{-1});
    if (!material.strands) continue;
    part.laws.push_back({material.strands->residual_factor, material.strands->stretch_limit});
  }
  if (materials.size() == 1) return part;
  part.tet_laws.reserve(material_of.size());
  for (const int32_t material : material_of)
    part.tet_laws.push_back(law_of[static_cast<size_t>(material)]);
  return part;
}

// The client's nodes of the solver's edges.
std::vector<std::array<int32_t, 2>> ClientEdgeNodes(const Incidence& incidence,
                                                    const MeshOrder& order) {
  std::vector<std::array<int32_t, 2>> nodes;
  nodes.reserve(incidence.edges.size());
  for (const auto& [a, b] : incidence.edges) {
    nodes.push_back(
        {order.old_node[static_cast<size_t>(a)], order.old_node[static_cast<size_t>(b)]});
  }
  return nodes;
}

// The client's ids of the solver's edges: ranks by the client's node ids.
std::vector<int32_t> ClientEdges(const Incidence& incidence, const MeshOrder& order) {
  struct Entry {
    int32_t small, large, edge;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(incidence.edges.size());
  for (const auto& [a, b] : incidence.edges) {
    const int32_t old_a = order.old_node[static_cast<size_t>(a)];
    const int32_t old_b = order.old_node[static_cast<size_t>(b)];
    entries.push_back(
        {std::min(old_a, old_b), std::max(old_a, old_b), static_cast<int32_t>(entries.size())});
  }
  std::sort(entries.begin(), entries.end());
  std::vector<int32_t> client(entries.size());
  for (size_t rank = 0; rank < entries.size(); ++rank)
    client[static_cast<size_t>(entries[rank].edge)] = static_cast<int32_t>(rank);
  return client;
}

}  // namespace

absl::StatusOr<Model> BuildModel(const Scene& scene, const TetMesh& mesh) {
  if (mesh.tets.empty()) return absl::InvalidArgumentError("mesh: it has no tets");
  Model model;

  // The mesh in the solver's order.
  model.order = LocalityOrder(mesh);
  model.mesh = std::make_unique<const TetMesh>(Reordered(mesh, model.order));
  model.incidence = std::make_unique<const Incidence>(BuildIncidence(*model.mesh));
  model.mean_edge_length = MeanEdgeLength(*model.mesh, *model.incidence);

  // Lumped mass: a quarter of each tet to each of its nodes.
  const std::vector<int32_t> material_of =
      AssignMaterials(scene.materials, *model.mesh, RegionIndex(*model.mesh));
  model.masses.assign(static_cast<size_t>(mesh.node_count()), 0);
  for (size_t tet = 0; tet < material_of.size(); ++tet) {
    if (material_of[tet] < 0)
      return absl::InvalidArgumentError(
          absl::StrCat("materials: none covers tet ", model.order.old_tet[tet]));
    const double volume = SignedVolume(CornersOf(*model.mesh, static_cast<int64_t>(tet)));
    const double density = scene.materials[static_cast<size_t>(material_of[tet])].density;
    for (const int32_t node : model.mesh->tets[tet])
      model.masses[static_cast<size_t>(node)] += density * volume / 4;
  }

  // Elasticity, fibres and plasticity, a term for every law, number of families and whether it
  // flows.
  const std::vector<MaterialFibres> fibres =
      FibresOf(scene.materials, material_of, mesh, model.order);
  for (const ElasticKind& kind : KindsOf(scene.materials)) {
    ElasticPart part;
    part.law = kind.law;
    part.tets = TetsOf(scene.materials, material_of, kind);
    if (part.tets.empty()) continue;
    part.lame = LameOf(scene.materials, material_of, part.tets);
    model.fibrous |= kind.families > 0;
    for (size_t k = 0; k < kind.families; ++k) {
      part.fibres.push_back(StiffFamily(scene.materials, material_of, fibres, part.tets, k));
    }
    if (kind.ductile) part.plasticity = PlasticityOf(scene.materials, material_of, part.tets);
    if (part.tets.size() == material_of.size()) part.tets.clear();  // all of the mesh
    if (kind.ductile) {
      std::unique_ptr<PlasticTerm> term =
          MakePlasticTerm(scene.quality.precision, *model.mesh, *model.incidence, std::move(part),
                          scene.fracture.stress);
      model.plastic_terms.push_back(term.get());
      model.tet_terms.push_back(std::move(term));
      continue;
    }
    model.tet_terms.push_back(MakeElasticTerm(scene.quality.precision, *model.mesh,
                                              *model.incidence, std::move(part),
                                              scene.fracture.stress));
  }
  const std::vector<DirectionalStrength> directional =
      DirectionalStrengths(scene.materials, fibres);

  model.quality = scene.quality;

  // Gravity.
  model.gravity = scene.gravity;

  // Rayleigh damping.
  if (IsDamped(scene)) model.damping = scene.damping;

  // Prescribed motions.
  for (const Motion& motion : scene.motions) {
    PrescribedMotion part;
    part.nodes = NodesOf(motion.node_set, scene, mesh, model.order);
    std::erase_if(part.nodes, [&](int32_t n) { return model.masses[static_cast<size_t>(n)] == 0; });
    for (size_t i = 0; i < 3; ++i) part.axes[i] = motion.axes[i] ? -1 : 0;
    part.keyframes = motion.keyframes;
    part.center = ToDouble4(motion.rotation_center);
    part.axis = ToDouble4(motion.rotation_axis);
    part.axis /= std::sqrt(Dot(part.axis, part.axis));
    part.release = AddRelease(motion.release, scene, mesh, model);
    model.motions.push_back(std::move(part));
  }

  // Loads, a term each.
  for (const Load& load : scene.loads) {
    std::vector<int32_t> nodes = NodesOf(load.node_set, scene, mesh, model.order);
    std::erase_if(nodes, [&](int32_t n) { return model.masses[static_cast<size_t>(n)] == 0; });
    model.node_terms.push_back(MakeLoadTerm(load, std::move(nodes), *model.mesh, *model.incidence,
                                            AddRelease(load.release, scene, mesh, model)));
  }

  // Colliders. Those that move bring unknowns of their own.
  if (!scene.colliders.empty()) {
    auto term = std::make_unique<ColliderTerm>(
        scene, NodeStiffness(scene.materials, material_of, model), model);
    model.colliders = term.get();
    model.node_terms.push_back(std::move(term));
  }

  // Contact between pieces.
  if (scene.contact) {
    model.node_terms.push_back(std::make_unique<FragmentContact>(
        *scene.contact, NodeStiffness(scene.materials, material_of, model), model));
  }

  // Sleep of pieces at rest.
  model.sleep = scene.sleep;

  // Fracture, where something can break.
  if (CanBreak(scene)) {
    FracturePart& part = model.fracture.emplace();
    std::optional<BakedImpurities> baked;
    if (scene.impurities && (scene.impurities->model != ImpurityModel::kOff || WeakensEdges(scene)))
      baked = BakeImpurities(scene, mesh, ClientEdgeNodes(*model.incidence, model.order));
    const auto weaken = [&](std::vector<double>& thresholds) {
      WeakenEdges(scene, mesh, model.order, *model.incidence, thresholds);
      if (baked) CountFactors(baked->edge_factors, thresholds);
    };
    const auto strengths = [&](std::optional<double> Material::*strength) {
      std::vector<double> of_tet(material_of.size());
      for (size_t tet = 0; tet < of_tet.size(); ++tet) {
        const Material& material = scene.materials[static_cast<size_t>(material_of[tet])];
        of_tet[tet] = (material.*strength).value_or(kUnbreakable);
      }
      return of_tet;
    };
    const bool one_for_all = scene.materials.size() == 1 && !WeakensEdges(scene);
    if (one_for_all && directional.empty()) {
      part.edge_thresholds = {scene.materials[0].tensile_strength.value_or(kUnbreakable)};
    } else {
      const std::vector<double> tensile = strengths(&Material::tensile_strength);
      part.edge_thresholds =
          directional.empty() ? EdgeThresholds(*model.incidence, tensile)
                              : EdgeThresholds(*model.mesh, *model.incidence, tensile, directional);
      weaken(part.edge_thresholds);
    }

    // Strength in compression.
    const bool crushes = std::any_of(
        scene.materials.begin(), scene.materials.end(),
        [](const Material& material) { return material.compressive_strength.has_value(); });
    if (crushes && one_for_all) {
      part.compressive_thresholds = {*scene.materials[0].compressive_strength};
    } else if (crushes) {
      part.compressive_thresholds =
          EdgeThresholds(*model.incidence, strengths(&Material::compressive_strength));
      weaken(part.compressive_thresholds);
    }
    part.settings.simultaneity = scene.fracture.simultaneity;
    part.settings.aggregation = scene.fracture.aggregation;
    part.settings.reformulation = scene.fracture.reformulation;
    part.max_passes = scene.fracture.max_passes;
    part.client_edge = ClientEdges(*model.incidence, model.order);

    // Strands.
    if (PullsStrands(scene)) part.strands = StrandsOf(scene.materials, material_of);

    // Edge-projected damage, and what strands have of it.
    if (scene.fracture.reformulation == Reformulation::kEdgeProjected || part.strands) {
      auto term = std::make_unique<EdgeProjectedTerm>(*model.mesh, *model.incidence);
      part.edge_projected = term.get();
      model.tet_terms.push_back(std::move(term));
    }

    // Fatigue.
    if (Tires(scene)) part.fatigue = FatigueOf(scene.materials, material_of, *model.incidence);

    // Impurities, which change its thresholds.
    if (scene.impurities && scene.impurities->model != ImpurityModel::kOff)
      part.impurities = BuildImpurities(scene, baked->potencies, model.order, *model.incidence);
  }

  return model;
}

State InitialState(const Scene& scene, const TetMesh& mesh, const Model& model) {
  State state;
  state.displacements.assign(model.masses.size(), Splat(0));
  state.velocities = state.displacements;
  state.released.assign(model.releases.size(), 0);
  for (const InitialVelocity& initial : scene.initial_velocities) {
    const Vec3& spin = initial.angular_velocity;
    for (const int32_t node : NodesOf(initial.node_set, scene, mesh, model.order)) {
      const auto n = static_cast<size_t>(node);
      if (model.masses[n] == 0) continue;
      const Double4 arm = ToDouble4(model.mesh->rest_positions[n]) - ToDouble4(initial.center);
      const Double4 turning = {spin[1] * arm[2] - spin[2] * arm[1],
                               spin[2] * arm[0] - spin[0] * arm[2],
                               spin[0] * arm[1] - spin[1] * arm[0], 0};
      state.velocities[n] += ToDouble4(initial.velocity) + turning;
    }
  }
  if (model.colliders != nullptr) model.colliders->Start(state);
  return state;
}

}  // namespace cleave

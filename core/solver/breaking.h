#ifndef CLEAVE_CORE_SOLVER_BREAKING_H_
#define CLEAVE_CORE_SOLVER_BREAKING_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"
#include "core/damage/fatigue.h"
#include "core/damage/fracture.h"
#include "core/damage/random_graph.h"
#include "core/model/model.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// The breaking of a model's body: hands the stresses of its terms to EdgeFracture, and the damage
// back to the terms. Not thread-safe; loops run on the caller's TBB arena and give the same bits
// for any number of threads.
class Breaking {
 public:
  // `model.fracture` must be set; `model` must outlive this object.
  explicit Breaking(const Model& model);

  // One break pass at these displacements (m); the terms carry the new damage afterwards. Returns
  // whether there is any: edges broke or strands tore.
  bool BreakPass(const NodalVector& displacements);

  // To be called when a step has ended at these displacements (m) and will not be rolled back.
  void EndStep(const NodalVector& displacements);

  // Sets the stresses that break edges, at these displacements (m), in tets that are not left out.
  void FindStresses(const NodalVector& displacements);
  // Adds an influence (node_term.h) between the nodes of every strand.
  void AddStrandInfluences(std::vector<Influence>& influences) const;
  // Tets (not 0, a tet each; empty: none) that the terms leave out keep the stresses that they
  // have.
  void LeaveOut(std::vector<uint8_t> tets) { left_out_ = std::move(tets); }

  // The edges that the last pass broke, ascending, and what each took (EdgeBreak::energy); until
  // the next.
  std::span<const int32_t> newly_broken() const { return newly_broken_; }
  std::span<const double> break_energies() const { return break_energies_; }

  // Keeps the present state, for RollBack to return to.
  void Mark();
  absl::Status RollBack();

  // The client's ids, ascending.
  std::vector<int32_t> ClientBrokenEdges() const;
  int64_t broken_edge_count() const { return fracture_.broken_edge_count(); }
  // Of every tet what EdgeFracture::damage_factors says, but 0 for strands, which bear no load from
  // outside; until the next call.
  std::span<const double> SolidFactors();
  int64_t ComponentCount() { return fracture_.ComponentCount(); }
  const EdgeFracture& fracture() const { return fracture_; }

  void Save(ByteWriter& out) const;
  // Refuses (DataLoss) what cannot belong to this mesh, and then changes nothing.
  absl::Status Restore(ByteReader& in);

  int64_t bytes() const;

 private:
  double TetEnergy(int32_t tet, const NodalVector& displacements) const;
  // Adds what a tet has lost to `break_energies_`; returns what no edge of it took.
  double ShareOut(int32_t tet, double energy);
  // Hands the damage of a tet to the terms, at the displacements of its break.
  void Weaken(int32_t tet, const NodalVector& displacements);
  // Hands all damage to the terms; `betas` are those of edge-projected tets, by tet.
  void ApplyDamage(std::span<const double> betas);
  // Whether the edge-projected term has a live tet; where the model has that term.
  bool IsProjected(int32_t tet) const;
  // Such tets, ascending.
  std::vector<int32_t> ProjectedTets() const;
  Matrix6 RestModuli(int32_t tet) const;

  // Broken edges and what they leave of tets: what changes within a step.
  void SaveBroken(ByteWriter& out) const;
  absl::Status LoadBroken(ByteReader& in);

  // Strengths are those of the unbroken edges.
  void ResetStrengths();

  const Model& model_;
  std::optional<RandomGraph> graph_;      // where the model has impurities
  std::optional<FatigueDamage> fatigue_;  // where its materials tire
  EdgeFracture fracture_;
  std::vector<Vec3> positions_;            // m
  std::vector<Eigen::Matrix3d> stresses_;  // Pa
  std::vector<double> edge_stresses_;      // Pa, where the materials tire
  bool stresses_are_last_ = false;         // those of the last solve
  std::vector<uint8_t> left_out_;          // a tet each, or empty
  std::span<const int32_t> newly_broken_;
  std::vector<double> break_energies_;  // J, of these
  // Where tets are ductile: records of them, in the order of the plastic terms.
  std::vector<int32_t> plastic_record_of_;  // a tet each
  std::vector<PlasticTet> plastic_tets_;
  std::string mark_;
  int64_t marked_damage_ = 0;
  std::vector<double> solid_factors_;  // where there may be strands, once SolidFactors was called
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_BREAKING_H_

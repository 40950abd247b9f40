#ifndef CLEAVE_CORE_MODEL_FRAGMENT_CONTACT_H_
#define CLEAVE_CORE_MODEL_FRAGMENT_CONTACT_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/near_pairs.h"
#include "core/model/model.h"
#include "core/model/node_term.h"
#include "core/scene/scene.h"

namespace cleave {

// Contact between pieces of the body (method note, section 9).
//
// A broken edge stays a spring that only pushes: k/2 max(0, l - d)^2, k = c E V / L^2, V the volume
// round the edge, L its rest length and l the smaller of L and its length when it broke: crack
// faces do not close through each other. Nodes of different pieces repel each other alike with k =
// c E h below l, the smallest of h, their rest distance and how near they were when they first came
// within sight; as they part, l follows them up to the smaller of the first two. So no spring is
// born pressed, and none brings energy in. Friction between nodes of different pieces is that of
// ColliderTerm. All forces come in opposite pairs.
//
// Pieces are what connects through unbroken edges at the start of a step. Nothing is looked for,
// and no pair kept, before there are two.
class FragmentContact final : public NodeTerm {
 public:
  // `model` has its mesh and incidence, which outlive this term, masses and mean edge length.
  // `stiffness` is E h (N/m), one for all nodes or one each. Preconditions: ValidateScene holds.
  FragmentContact(const Contact& contact, std::vector<double> stiffness, const Model& model);

  absl::string_view name() const override { return "contact"; }
  int64_t bytes() const override;
  void StartBroken(std::span<const int32_t> edges) override;
  void EdgesBroke(std::span<const int32_t> edges, const NodalVector& displacements) override;
  double LongestPart(double start, double end, const State& state) const override;
  void BeginStep(double start, double end, const State& state) override;
  void AddInfluences(std::vector<Influence>& influences) const override;
  double AddForces(const NodalVector& displacements, NodalVector& forces) override;
  void AddStiffness(const NodalVector& displacements, Curvature curvature,
                    NodeCouplings& couplings) override;
  double RoundingForce(const NodalVector& displacements) const override;
  NodeTermWork EndStep(const State& state) override;
  void Save(ByteWriter& out) const override;
  absl::Status Restore(ByteReader& in) override;

  // When every edge has broken and every node has a few others in sight.
  static int64_t BytesOf(int64_t nodes, int64_t edges);

 private:
  using Vector = Eigen::Vector3d;

  // Without gaps between its members: it is saved as it lies in memory, and so is Pair.
  struct Spring {
    int64_t edge;
    double length;     // m, l
    double stiffness;  // N/m
  };
  // Two nodes of different pieces in sight of each other.
  struct Pair {
    int32_t first;
    int32_t second;
    double length;        // m, l
    double normal_force;  // N, at the end of the last step
    Vec3 anchor;          // m, from second to first, where friction pulls to; 0 without force
  };
  struct Active {
    double stiffness;  // N/m
    double cap;        // N, of friction
    Vector normal;     // from second to first, at the start
  };

  Vector PointOf(int32_t node, const NodalVector& displacements) const;
  double NodeStiffness(int32_t node) const;
  Spring SpringOf(int32_t edge, double length) const;
  double RestLength(int32_t i, int32_t j) const;  // m
  double FullLength(int32_t i, int32_t j) const;  // m, the longest l of a pair
  void UpdatePieces();
  // Calls push(i, j, normal from j to i, gap, stiffness, Active or null) for every spring that may
  // press.
  template <typename Push>
  void ForSprings(const NodalVector& displacements, const Push& push) const;
  // m, how far from each other nodes may be that could touch within `dt`.
  double Reach(double dt, const State& state) const;

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const double mean_edge_length_;  // m
  const double factor_;            // c
  const double friction_;
  const std::vector<double> node_stiffness_;  // N/m

  // What lasts.
  std::vector<Spring> springs_;
  std::vector<Pair> pairs_;   // ascending
  double stored_energy_ = 0;  // J

  // Follows from it.
  std::vector<int32_t> pieces_;  // a node each
  int32_t piece_count_ = 0;

  // Of the step.
  size_t old_springs_ = 0;  // those that had broken before it
  NodalVector start_displacements_;
  std::vector<Pair> sighted_;
  std::vector<Active> active_;  // of each of them
  NearPairs near_;
  std::vector<Vector> points_;
  double searched_reach_ = 0;  // m, of near_, with points_ and pieces_; 0: of others
  NodalVector scratch_forces_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_FRAGMENT_CONTACT_H_

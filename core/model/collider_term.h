#ifndef CLEAVE_CORE_MODEL_COLLIDER_TERM_H_
#define CLEAVE_CORE_MODEL_COLLIDER_TERM_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/rigid_body.h"
#include "core/contact/signed_distance.h"
#include "core/model/model.h"
#include "core/model/node_term.h"
#include "core/scene/scene.h"

namespace cleave {

// Where a collider is: a point that the scene puts at X is at turn * (X - from) + to.
struct ColliderPose {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    // m
};

// Nodes against rigid colliders, with friction (method note, section 9).
//
// A node at signed distance phi below the margin r of a collider has the energy k/2 (phi - r)^2,
// k = c E h, which goes on as a straight line once the node is deeper than the mean edge h: a
// collider that starts inside the body pushes with a bounded force. Friction is a spring of the
// same k from the node to an anchor on the collider, whose force ends at mu times the normal force
// of the end of the last step; there the anchor slips. A node at rest therefore does not creep.
//
// A collider with mass brings two unknowns, which stand behind the nodes in every nodal vector and
// have its mass: the displacement of its centre, and the vector that turns it within the step, in
// its principal axes and scaled to metres so that this mass fits. They are solved for together with
// the nodes, so that every impulse is equal on both sides. Angular momentum is carried over from
// step to step; within a step the inertia is that of its start.
class ColliderTerm final : public NodeTerm {
 public:
  // `model` has its mesh, which outlives this term, its masses and mean edge length; it gains the
  // unknowns of moving colliders. `stiffness` is E h (N/m), one for all nodes or one each.
  // Preconditions: ValidateScene holds.
  ColliderTerm(const Scene& scene, std::vector<double> stiffness, Model& model);

  // Sets the velocities of the unknowns of moving colliders.
  void Start(State& state) const;

  // Where the colliders are at `time` (s), in the scene's order.
  std::vector<ColliderPose> Poses(double time, const State& state) const;

  absl::string_view name() const override { return "colliders"; }
  int64_t bytes() const override;
  double LongestPart(double start, double end, const State& state) const override;
  void BeginStep(double start, double end, const State& state) override;
  void AddInfluences(std::vector<Influence>& influences) const override;
  double AddForces(const NodalVector& displacements, NodalVector& forces) override;
  void AddStiffness(const NodalVector& displacements, Curvature curvature,
                    NodeCouplings& couplings) override;
  double RoundingForce(const NodalVector& displacements) const override;
  NodeTermWork EndStep(const State& state) override;
  void Renew(State& state) override;
  void Save(ByteWriter& out) const override;
  absl::Status Restore(ByteReader& in) override;

  // What a node that touches costs, for the plan.
  static int64_t BytesPerNode();
  // And a collider of these many keyframes and triangles.
  static int64_t BytesOf(size_t keyframes, size_t triangles);

 private:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  struct Body {
    Body() {}  // or Clang takes it for one that nothing constructs: it is complete behind Part

    MassProperties mass;
    size_t unknown = 0;  // of the displacement; that of the turn is the next
    Vector scale;        // m/rad of the turn's unknown, by principal axis
    Vector velocity;     // m/s at the start
    Vector spin;         // rad/s at the start
  };
  struct Part {
    ShapeDistance shape;
    PrescribedMotion motion;  // of no nodes
    std::optional<Body> body;
    double friction;
    double stiffness;
    double margin;
  };
  // A collider somewhere; of a moving one also what its turn's unknown turns.
  struct Pose {
    Matrix turn = Matrix::Identity();
    Vector from = Vector::Zero();
    Vector to = Vector::Zero();
    Matrix change = Matrix::Zero();  // rad/m

    Vector Apply(const Vector& point) const { return turn * (point - from) + to; }
    Vector Invert(const Vector& point) const { return turn.transpose() * (point - to) + from; }
  };
  // What lasts from step to step of a node that touches a collider.
  struct Touch {
    int32_t collider;
    int32_t node;
    double normal_force;  // N
    Vec3 anchor;          // m, on the collider where the scene puts it
  };
  // A node that may touch a collider in this step.
  struct Candidate {
    int32_t collider;
    int32_t node;
    double stiffness;      // N/m
    double friction_cap;   // N, 0 without friction
    Vector normal;         // at the start, in space
    Vector anchor;         // m, as in Touch
    Vector start_surface;  // m, the collider's point at the node, where it is at the start
  };
  struct Normal {
    double energy;  // J
    double force;   // N
    double slope;   // N/m
  };

  Vector PointOf(int32_t node, const NodalVector& displacements) const;
  Pose StartPose(size_t collider, double time, const NodalVector& displacements) const;
  Pose TrialPose(size_t collider, const NodalVector& displacements) const;
  // What the normal spring does at distance `gap` from where it starts, negative when pressed.
  Normal Press(double stiffness, double gap) const;
  // Calls found(node, distance, velocity of the node against the surface) for each node that could
  // come to touch within `dt`.
  template <typename Found>
  void ForNearNodes(size_t collider, const Pose& start, const Pose& end, double dt,
                    const State& state, const Found& found) const;
  // Adds the stiffness of a spring between a node and the collider's point `arm` from its centre.
  void AddSpring(const Candidate& candidate, const Pose& pose, const Matrix& spring,
                 const Vector& arm, NodeCouplings& couplings) const;

  const TetMesh& mesh_;
  const double mean_edge_length_;             // m
  std::vector<int32_t> nodes_;                // with mass, ascending
  const std::vector<double> node_stiffness_;  // N/m
  const Vector gravity_;                      // m/s^2
  std::vector<Part> parts_;

  // What lasts.
  std::vector<Touch> touches_;             // by collider, then node
  std::vector<Eigen::Quaterniond> turns_;  // of every collider with mass, in their order
  double stored_energy_ = 0;               // J

  // Of the step.
  double end_ = 0;                   // s
  NodalVector start_displacements_;  // of the unknowns of moving colliders
  std::vector<Pose> start_poses_;
  std::vector<Pose> end_poses_;  // of colliders that do not answer
  std::vector<Candidate> candidates_;
  NodalVector scratch_forces_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_COLLIDER_TERM_H_

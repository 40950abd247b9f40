#include "core/model/fragment_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/counter_rng.h"
#include "core/model/build_model.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kStep = 0.01;

// Two unit cubes, one above the other, a gap apart.
TetMesh TwoCubes(double gap) {
  TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  const TetMesh upper = KuhnBox({2, 2, 2}, {1, 1, 1}, {0.1, 0.05, 1 + gap});
  const auto offset = static_cast<int32_t>(mesh.node_count());
  mesh.rest_positions.insert(mesh.rest_positions.end(), upper.rest_positions.begin(),
                             upper.rest_positions.end());
  for (auto tet : upper.tets) {
    for (int32_t& node : tet) node += offset;
    mesh.tets.push_back(tet);
  }
  return mesh;
}

struct Fixture {
  explicit Fixture(double friction, double gap = 0.6) : mesh(TwoCubes(gap)) {
    scene.contact = Contact{2, friction};
    model = *BuildModel(scene, mesh);
    state = InitialState(scene, mesh, model);
  }
  NodeTerm& term() { return *model.node_terms[0]; }

  // Moves the upper cube.
  State Moved(Double4 by) const {
    State moved = state;
    for (size_t n = 0; n < moved.displacements.size(); ++n) {
      if (model.mesh->rest_positions[n][2] > 1.01) moved.displacements[n] += by;
      for (uint64_t k = 0; k < 3; ++k) {
        moved.displacements[n][k] += 0.01 * (UniformDraw(3, RandomStream::kMeshJitter, n, k) - 0.5);
      }
    }
    return moved;
  }

  TetMesh mesh;
  Scene scene = TightScene(1e4, 0.3, 1000, kStep);
  Model model;
  State state;
};

TEST(FragmentContact, ForcesAndStiffnessAreSlopesAndPairsCancel) {
  for (const double friction : {0.0, 0.5}) {
    Fixture f(friction);
    // Pressed, then slid: friction has a normal force to go by.
    f.term().BeginStep(0, kStep, f.state);
    const State pressed = f.Moved(Double4{0, 0, -0.3, 0});
    f.term().EndStep(pressed);
    f.term().BeginStep(kStep, 2 * kStep, pressed);
    const NodalVector x = f.Moved(Double4{0.02, 0, -0.31, 0}).displacements;
    NodalVector forces(x.size(), Splat(0));
    EXPECT_GT(f.term().AddForces(x, forces), 0);
    Double4 sum = Splat(0);
    double size = 0;
    for (const Double4& force : forces) {
      sum += force;
      size += std::sqrt(Dot(force, force));
    }
    EXPECT_GT(size, 100);
    EXPECT_LT(std::sqrt(Dot(sum, sum)), 1e-13 * size);

    NodeCouplings couplings;
    f.term().AddStiffness(x, Curvature::kSemidefinite, couplings);
    couplings.Gather();
    constexpr double kDifference = 1e-7;
    for (size_t n = 0; n < x.size(); ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        NodalVector more = x, less = x, up(x.size(), Splat(0)), down = up;
        more[n][axis] += kDifference;
        less[n][axis] -= kDifference;
        const double slope =
            (f.term().AddForces(more, up) - f.term().AddForces(less, down)) / (2 * kDifference);
        EXPECT_NEAR(-slope, forces[n][axis], 1e-4 + 1e-5 * std::abs(slope));
        // Less the part that a turning normal takes away, which is negative.
        double diagonal = 0;
        for (const auto& entry :
             couplings.Rows(static_cast<int64_t>(n), static_cast<int64_t>(n) + 1)) {
          if (entry.column == static_cast<int32_t>(n)) diagonal += entry.columns[axis][axis];
        }
        EXPECT_GE(diagonal, -(up[n][axis] - down[n][axis]) / (2 * kDifference) - 1);
      }
    }
  }
}

TEST(FragmentContact, SpringsAreNotBornPressed) {
  // Nodes of two cubes nearer to each other than the edge are at rest.
  Fixture f(0, 0.05);
  f.term().BeginStep(0, kStep, f.state);
  NodalVector forces(f.state.displacements.size(), Splat(0));
  EXPECT_EQ(f.term().AddForces(f.state.displacements, forces), 0);
  EXPECT_GT(f.term().AddForces(f.Moved(Double4{0, 0, -0.04, 0}).displacements, forces), 0);
}

TEST(FragmentContact, ABrokenEdgePushesOnceItIsShorterThanItWas) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  Scene scene = TightScene(1e4, 0.3, 1000, kStep);
  scene.contact.emplace();
  Model model = *BuildModel(scene, mesh);
  NodeTerm& term = *model.node_terms[0];
  State state = InitialState(scene, mesh, model);
  term.BeginStep(0, kStep, state);
  const auto [i, j] = model.incidence->edges[0];
  const auto a = static_cast<size_t>(i), b = static_cast<size_t>(j);
  Double4 along =
      ToDouble4(model.mesh->rest_positions[b]) - ToDouble4(model.mesh->rest_positions[a]);
  const auto stretched = [&](double share) {
    NodalVector x = state.displacements;
    x[b] += share * along;
    return x;
  };
  NodalVector forces(state.displacements.size(), Splat(0));
  // It breaks while shorter than at rest: from there on it pushes.
  const int32_t edge = 0;
  term.EdgesBroke({&edge, 1}, stretched(-0.1));
  EXPECT_EQ(term.AddForces(stretched(-0.09), forces), 0);
  const double energy = term.AddForces(stretched(-0.3), forces);
  EXPECT_GT(energy, 0);
  // Taken back with the step.
  term.BeginStep(0, kStep / 2, state);
  EXPECT_EQ(term.AddForces(stretched(-0.3), forces), 0);
  // Stretched when it breaks, it pushes from its rest length on; and lasts.
  term.EdgesBroke({&edge, 1}, stretched(0.2));
  term.EndStep(state);
  term.BeginStep(kStep, 2 * kStep, state);
  EXPECT_EQ(term.AddForces(stretched(0.01), forces), 0);
  EXPECT_GT(term.AddForces(stretched(-0.3), forces), energy);
}

// What an earlier call may have left where the next ones keep their locals.
[[gnu::noinline]] void LeaveBehind(int byte) {
  volatile unsigned char left[4096];
  for (volatile unsigned char& at : left) at = static_cast<unsigned char>(byte);
}

TEST(FragmentContact, SavesTheSameBytesWhateverLayInMemory) {
  const auto saved = [](int byte) {
    Fixture f(0, 0.2);
    const int32_t edge = 0;
    LeaveBehind(byte);
    f.term().EdgesBroke({&edge, 1}, f.state.displacements);
    std::string bytes;
    ByteWriter out(bytes);
    f.term().Save(out);
    return bytes;
  };
  EXPECT_EQ(saved(0), saved(0x5a));
}

TEST(FragmentContact, OnePieceKeepsNoPairs) {
  const TetMesh mesh = KuhnBox({3, 3, 3}, {1, 1, 1});
  Scene scene = TightScene(1e4, 0.3, 1000, kStep);
  scene.contact.emplace();
  Model model = *BuildModel(scene, mesh);
  const State state = InitialState(scene, mesh, model);
  const int64_t before = model.node_terms[0]->bytes();
  model.node_terms[0]->BeginStep(0, kStep, state);
  model.node_terms[0]->EndStep(state);
  EXPECT_EQ(model.node_terms[0]->bytes(), before);
  // Which pieces nodes are of, and one stiffness.
  EXPECT_EQ(before, mesh.node_count() * 4 + 8);
}

TEST(FragmentContact, RefusesTheStateOfAnotherMesh) {
  Fixture f(0.5, 0.3);
  f.term().BeginStep(0, kStep, f.state);
  f.term().EndStep(f.Moved(Double4{0, 0, -0.3, 0}));
  std::string saved;
  ByteWriter out(saved);
  f.term().Save(out);
  ByteReader whole(saved);
  EXPECT_TRUE(f.term().Restore(whole).ok());
  ByteReader cut(absl::string_view(saved).substr(0, 20));
  EXPECT_EQ(f.term().Restore(cut).code(), absl::StatusCode::kDataLoss);
  saved[8 + 8] = 99;  // after the count of springs, none, and that of pairs
  saved[8 + 8 + 1] = 99;
  ByteReader other(saved);
  EXPECT_EQ(f.term().Restore(other).code(), absl::StatusCode::kDataLoss);
}

}  // namespace
}  // namespace cleave

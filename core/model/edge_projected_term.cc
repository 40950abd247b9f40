#include "core/model/edge_projected_term.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/mesh/tet_geometry.h"
#include "core/model/batch_scatter.h"
#include "core/model/tet_batches.h"

namespace cleave {
namespace {

constexpr int64_t kGrain = 64;  // tets worth a task

}  // namespace

struct EdgeProjectedTerm::Edges {
  Double4 vector[6];  // m
  Vector6 q;          // m^2

  Edges(const TetMesh& mesh, int32_t tet, const NodalVector& displacements) {
    const std::array<int32_t, 4>& nodes = mesh.tets[static_cast<size_t>(tet)];
    for (int k = 0; k < 6; ++k) {
      const auto i =
          static_cast<size_t>(nodes[static_cast<size_t>(kTetEdges[static_cast<size_t>(k)][0])]);
      const auto j =
          static_cast<size_t>(nodes[static_cast<size_t>(kTetEdges[static_cast<size_t>(k)][1])]);
      const Double4 rest = ToDouble4(mesh.rest_positions[j]) - ToDouble4(mesh.rest_positions[i]);
      const Double4 moved = displacements[j] - displacements[i];
      vector[k] = rest + moved;
      // Without the difference of two large squares.
      q[k] = Dot(rest + 0.5 * moved, moved);
    }
  }
};

std::vector<std::unique_ptr<EdgeProjectedTerm::Tet>>::iterator EdgeProjectedTerm::Find(
    int64_t tet) {
  return std::lower_bound(tets_.begin(), tets_.end(), tet,
                          [](const auto& entry, int64_t id) { return entry->tet < id; });
}

const EdgeProjectedTerm::Tet* EdgeProjectedTerm::Get(int64_t tet) const {
  const auto found = const_cast<EdgeProjectedTerm*>(this)->Find(tet);
  return found != tets_.end() && (*found)->tet == tet ? found->get() : nullptr;
}

void EdgeProjectedTerm::Put(int64_t tet, EdgeMask broken, const Matrix6& moduli, double beta) {
  auto at = Find(tet);
  if (at == tets_.end() || (*at)->tet != tet) at = tets_.insert(at, std::make_unique<Tet>());
  Tet& entry = **at;
  entry.tet = static_cast<int32_t>(tet);
  entry.beta = beta;
  entry.moduli = beta * RestVolume(mesh_, tet) *
                 CondenseBrokenEdges(EdgeModuli(CornersOf(mesh_, tet), moduli), broken);
}

void EdgeProjectedTerm::Weaken(int64_t tet, EdgeMask broken, const Matrix6& moduli, double factor,
                               double energy, const NodalVector& displacements) {
  const Tet* const earlier = Get(tet);
  const double beta = earlier != nullptr ? std::min(earlier->beta, factor) : factor;
  Put(tet, broken, moduli, beta);
  const double now = TetEnergy(tet, displacements);
  if (now > energy) Put(tet, broken, moduli, beta * std::max(energy, 0.0) / now);
}

std::vector<double> EdgeProjectedTerm::betas() const {
  std::vector<double> betas;
  betas.reserve(tets_.size());
  for (const auto& entry : tets_) betas.push_back(entry->beta);
  return betas;
}

int64_t EdgeProjectedTerm::TetBytes() { return sizeof(Tet) + sizeof(std::unique_ptr<Tet>); }

int64_t EdgeProjectedTerm::bytes() const { return static_cast<int64_t>(tets_.size()) * TetBytes(); }

double EdgeProjectedTerm::TetEnergy(int64_t tet, const NodalVector& displacements) const {
  const Tet* const entry = Get(tet);
  if (entry == nullptr) return 0;
  const Edges edges(mesh_, entry->tet, displacements);
  return 0.5 * edges.q.dot(entry->moduli * edges.q);
}

void EdgeProjectedTerm::SetDamageFactor(int64_t tet, double factor) {
  if (factor != 0) return;
  const auto found = Find(tet);
  if (found != tets_.end() && (*found)->tet == tet) tets_.erase(found);
}

double EdgeProjectedTerm::AddForces(const NodalVector& displacements, NodalVector& forces) {
  ParallelFor(static_cast<int64_t>(tets_.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t place = begin; place < end; ++place) {
      Tet& entry = *tets_[static_cast<size_t>(place)];
      const Edges edges(mesh_, entry.tet, displacements);
      const Vector6 pull = entry.moduli * edges.q;
      entry.energy = 0.5 * edges.q.dot(pull);
      std::fill(std::begin(entry.force), std::end(entry.force), Splat(0));
      for (int k = 0; k < 6; ++k) {
        const Double4 force = pull[k] * edges.vector[k];
        entry.force[kTetEdges[static_cast<size_t>(k)][0]] += force;
        entry.force[kTetEdges[static_cast<size_t>(k)][1]] -= force;
      }
    }
  });
  double energy = 0;
  for (const auto& entry : tets_) {
    energy += entry->energy;
    const std::array<int32_t, 4>& nodes = mesh_.tets[static_cast<size_t>(entry->tet)];
    for (size_t vertex = 0; vertex < 4; ++vertex)
      forces[static_cast<size_t>(nodes[vertex])] += entry->force[vertex];
  }
  return energy;
}

void EdgeProjectedTerm::AddStiffness(const NodalVector& displacements, Curvature curvature,
                                     EdgeBlocks& blocks) {
  ParallelFor(static_cast<int64_t>(tets_.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t place = begin; place < end; ++place) {
      Tet& entry = *tets_[static_cast<size_t>(place)];
      const std::array<int32_t, 4>& nodes = mesh_.tets[static_cast<size_t>(entry.tet)];
      const Edges edges(mesh_, entry.tet, displacements);
      const Vector6 pull = entry.moduli * edges.q;
      // How a vertex's position changes q of every edge.
      Eigen::Matrix<double, 3, 6> slope[4];
      for (auto& of_vertex : slope) of_vertex.setZero();
      for (int k = 0; k < 6; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
          slope[kTetEdges[static_cast<size_t>(k)][0]](axis, k) = -edges.vector[k][axis];
          slope[kTetEdges[static_cast<size_t>(k)][1]](axis, k) = edges.vector[k][axis];
        }
      }
      for (size_t k = 0; k < 6; ++k) {
        auto [i, j] = kTetEdges[k];
        if (nodes[static_cast<size_t>(i)] > nodes[static_cast<size_t>(j)]) std::swap(i, j);
        Eigen::Matrix3d block = -(slope[i] * entry.moduli * slope[j].transpose());
        // What pushes the ends apart bends sideways: it counts only where it may.
        const double tension = pull[static_cast<int>(k)];
        if (tension > 0 || curvature == Curvature::kExact) block.diagonal().array() += tension;
        Eigen::Map<Eigen::Matrix3f>(entry.block[k]) = block.cast<float>();
      }
    }
  });
  for (const auto& entry : tets_) {
    for (size_t k = 0; k < 6; ++k) {
      const auto edge =
          static_cast<size_t>(incidence_.tet_edges[static_cast<size_t>(entry->tet)][k]);
      float* const target = blocks.data() + 9 * edge;
      for (int m = 0; m < 9; ++m) target[m] += entry->block[k][m];
    }
  }
}

}  // namespace cleave

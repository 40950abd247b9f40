#include "client/io/series/surface_sequence.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "absl/strings/str_cat.h"
#include "client/io/series/frame_check.h"
#include "core/base/faults.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/fans.h"
#include "core/surface/shared_edges.h"

namespace cleave {
namespace {

using Eigen::Matrix3f;

// Edge vectors of a tet from its first corner, as columns.
Eigen::Matrix3d EdgeMatrix(const std::vector<Vec3>& positions, const std::array<int32_t, 4>& tet) {
  const auto at = [&](size_t k) {
    return Eigen::Map<const Eigen::Vector3d>(positions[static_cast<size_t>(tet[k])].data());
  };
  Eigen::Matrix3d edges;
  for (size_t k = 1; k < 4; ++k) edges.col(static_cast<Eigen::Index>(k) - 1) = at(k) - at(0);
  return edges;
}

// For each point, the mean over the nodes on its side.
void MeanOfOwners(const SurfaceTopology& topology, const std::vector<float>& node_values,
                  std::vector<float>& values) {
  values.resize(topology.points.size());
  for (size_t i = 0; i < topology.points.size(); ++i) {
    const SurfacePoint& point = topology.points[i];
    float sum = 0;
    float count = 0;
    for (size_t k = 0; k < point.node_count; ++k) {
      if ((point.owners >> k & 1) == 0) continue;
      sum += node_values[static_cast<size_t>(point.nodes[k])];
      count += 1;
    }
    values[i] = count > 0 ? sum / count : 0.0f;
  }
}

}  // namespace

SurfaceSequence::SurfaceSequence(const TetMesh& mesh, const SequenceOptions& options)
    : mesh_(mesh),
      options_(options),
      incidence_(BuildIncidence(mesh)),
      faces_(BuildFaces(mesh)),
      moved_(mesh_, incidence_) {
  if (!options_.strains) return;
  rest_inverses_.resize(mesh.tets.size());
  rest_volumes_.resize(mesh.tets.size());
  ParallelFor(mesh.tet_count(), 2048, [&](int64_t begin, int64_t end) {
    for (auto t = static_cast<size_t>(begin); t < static_cast<size_t>(end); ++t) {
      const Eigen::Matrix3d edges = EdgeMatrix(mesh_.rest_positions, mesh_.tets[t]);
      const double volume = edges.determinant() / 6;
      rest_volumes_[t] = static_cast<float>(std::max(volume, 0.0));
      Eigen::Map<Matrix3f> inverse(rest_inverses_[t].data());
      if (volume > 0) {
        inverse = edges.inverse().cast<float>();
      } else {
        inverse.setZero();
      }
    }
  });
}

absl::Status SurfaceSequence::CheckKnown(const Frame& frame) const {
  if (frame.visible.empty()) return absl::OkStatus();
  Faults faults;
  const auto refuse = [&](bool wanted, const char* field) {
    if (wanted)
      faults.Error(field, absl::StrCat("frame ", frame.frame,
                                       " is of a surface view, which does not tell of all nodes"));
  };
  refuse(options_.strains, "strains");
  refuse(options_.velocities, "velocities");
  refuse(options_.render_mesh != nullptr, "render_mesh");
  return faults.ToStatus();
}

absl::Status SurfaceSequence::GoOn(const Frame& frame) {
  CLEAVE_RETURN_IF_ERROR(CheckKnown(frame));
  CLEAVE_RETURN_IF_ERROR(CheckFrame(frame, mesh_, incidence_.edge_count(), last_time_));
  last_time_ = frame.time;
  changed_ = !pieces_ || frame.broken_edges != broken_edges_;
  if (changed_) Follow(frame);
  moved_.Advance(topology(), changed_, frame.positions, frame.time, options_.velocities);
  return absl::OkStatus();
}

absl::Status SurfaceSequence::PassBy(const Frame& frame) { return GoOn(frame); }

absl::Status SurfaceSequence::Advance(const Frame& frame) {
  CLEAVE_RETURN_IF_ERROR(GoOn(frame));
  if (is_stale_) TakeApart();
  shown_.points = moved_.points();
  shown_.velocities = moved_.velocities();
  if (options_.displacements) shown_.displacements = Displacements(topology(), shown_.points);
  if (options_.strains) FindStrains(frame.positions);
  shown_.frame = frame.frame;
  shown_.time = frame.time;
  shown_.broken_edges = static_cast<int64_t>(frame.broken_edges.size());
  return absl::OkStatus();
}

void SurfaceSequence::Follow(const Frame& frame) {
  const bool goes_on =
      pieces_ && std::includes(frame.broken_edges.begin(), frame.broken_edges.end(),
                               broken_edges_.begin(), broken_edges_.end());
  if (!goes_on) {
    broken_edges_.clear();
    pieces_.emplace(mesh_, incidence_);
    if (options_.render_mesh != nullptr) {
      embedded_.emplace(mesh_, incidence_, faces_, *options_.render_mesh);
    } else {
      surface_.emplace(mesh_, incidence_, faces_, SurfaceOptions{});
    }
  }
  std::vector<int32_t> edges;
  std::set_difference(frame.broken_edges.begin(), frame.broken_edges.end(), broken_edges_.begin(),
                      broken_edges_.end(), std::back_inserter(edges));
  broken_edges_ = frame.broken_edges;
  pieces_->Break(edges);
  if (embedded_) {
    embedded_->Break(edges, *pieces_);
    topology_ = embedded_->topology();
    uvs_ = embedded_->uvs();
    sources_ = embedded_->sources();
  } else {
    surface_->Break(edges);
    topology_ = surface_->topology();
  }
  SeparateSharedEdges(topology_, uvs_, sources_);
  SeparateFans(topology_);
  is_stale_ = true;
}

void SurfaceSequence::TakeApart() {
  is_stale_ = false;
  node_pieces_.resize(mesh_.rest_positions.size());
  for (size_t node = 0; node < node_pieces_.size(); ++node)
    node_pieces_[node] = pieces_->piece_of(static_cast<int32_t>(node));
  Show();
  if (options_.sources) FindSources();
  if (options_.damages) FindDamages();
  if (!options_.node_potencies.empty()) FindPotencies();
}

void SurfaceSequence::Show() {
  const SurfaceTopology& topology = this->topology();
  const size_t triangles = topology.triangles.size();
  shown_.triangles = topology.triangles;
  shown_.inside = topology.inside;
  shown_.uvs = uvs_;
  shown_.pieces.resize(triangles);
  shown_.regions.resize(triangles);
  for (size_t i = 0; i < triangles; ++i) {
    shown_.pieces[i] = node_pieces_[static_cast<size_t>(topology.nodes[i])];
    shown_.regions[i] = mesh_.region_of(topology.tets[i]);
  }
  shown_.rest_points.resize(topology.points.size());
  for (size_t i = 0; i < topology.points.size(); ++i) {
    shown_.rest_points[i] = topology.points[i].rest;
  }
}

void SurfaceSequence::FindSources() {
  shown_.sources.assign(topology().triangles.size(), -1);
  for (size_t i = 0; i < shown_.sources.size(); ++i) {
    if (topology().inside[i] != 0) continue;
    shown_.sources[i] = embedded_
                            ? int64_t{sources_[i]}
                            : static_cast<int64_t>(surface_id::PartOf(topology().triangle_ids[i]));
  }
}

std::vector<float> SurfaceSequence::TetStrains(const std::vector<Vec3>& positions) const {
  std::vector<float> strains(rest_inverses_.size());
  ParallelFor(static_cast<int64_t>(strains.size()), 2048, [&](int64_t begin, int64_t end) {
    Eigen::SelfAdjointEigenSolver<Matrix3f> eigen;
    for (auto t = static_cast<size_t>(begin); t < static_cast<size_t>(end); ++t) {
      if (rest_volumes_[t] <= 0) continue;
      const Matrix3f gradient = EdgeMatrix(positions, mesh_.tets[t]).cast<float>() *
                                Eigen::Map<const Matrix3f>(rest_inverses_[t].data());
      eigen.computeDirect(gradient.transpose() * gradient, Eigen::EigenvaluesOnly);
      const float stretch = std::sqrt(std::max(eigen.eigenvalues()[2], 0.0f));
      strains[t] = std::isfinite(stretch) ? stretch - 1 : 0.0f;
    }
  });
  return strains;
}

std::vector<float> SurfaceSequence::TetDamages() const {
  std::vector<float> damages;
  damages.reserve(topology().tet_masks.size());
  for (const EdgeMask mask : topology().tet_masks) {
    damages.push_back(static_cast<float>(std::popcount(mask)) / 6);
  }
  return damages;
}

void SurfaceSequence::FindDamages() {
  const std::vector<float> tet_damages = TetDamages();
  std::vector<float> node_damages(mesh_.rest_positions.size());
  for (int64_t node = 0; node < mesh_.node_count(); ++node) {
    const auto tets = incidence_.node_tets[node];
    float sum = 0;
    for (const int32_t tet : tets) sum += tet_damages[static_cast<size_t>(tet)];
    node_damages[static_cast<size_t>(node)] =
        tets.empty() ? 0 : sum / static_cast<float>(tets.size());
  }
  MeanOfOwners(topology(), node_damages, shown_.damages);
}

void SurfaceSequence::FindPotencies() {
  const std::vector<double>& potencies = options_.node_potencies;
  double worst = 0;
  for (const double potency : potencies) worst = std::max(worst, std::abs(potency));
  shown_.potencies.resize(topology().points.size());
  shown_.impurities.resize(topology().points.size());
  for (size_t i = 0; i < topology().points.size(); ++i) {
    const SurfacePoint& point = topology().points[i];
    double mean = 0;
    for (size_t k = 0; k < point.node_count; ++k) {
      mean += point.weights[k] * potencies[static_cast<size_t>(point.nodes[k])];
    }
    shown_.potencies[i] = static_cast<float>(mean);
    shown_.impurities[i] = worst > 0 ? static_cast<float>(std::abs(mean) / worst) : 0;
  }
}

void SurfaceSequence::FindStrains(const std::vector<Vec3>& positions) {
  const std::vector<float> tet_strains = TetStrains(positions);
  std::vector<float> node_strains(mesh_.rest_positions.size());
  ParallelFor(mesh_.node_count(), 2048, [&](int64_t begin, int64_t end) {
    for (int64_t node = begin; node < end; ++node) {
      float sum = 0;
      float volume = 0;
      for (const int32_t tet : incidence_.node_tets[node]) {
        const auto t = static_cast<size_t>(tet);
        if (Separated(topology().tet_masks[t])) continue;
        sum += rest_volumes_[t] * tet_strains[t];
        volume += rest_volumes_[t];
      }
      node_strains[static_cast<size_t>(node)] = volume > 0 ? sum / volume : 0.0f;
    }
  });
  MeanOfOwners(topology(), node_strains, shown_.strains);
}

}  // namespace cleave

#include "client/io/preview/motion_survey.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/surface/fragments.h"

namespace cleave {
namespace {

constexpr int64_t kPointFrames = 64;
constexpr int64_t kPointsAFrame = 4096;
constexpr double kCrumb = 0.005;  // of the nodes
constexpr int32_t kLeastNodes = 4;

// `count` positions of [0, total), evenly spaced, first and last among them.
std::vector<int64_t> EvenPositions(int64_t total, int64_t count) {
  std::vector<int64_t> positions;
  const int64_t kept = std::min(total, std::max<int64_t>(count, 1));
  for (int64_t i = 0; i < kept; ++i) {
    positions.push_back(kept == 1 ? total - 1 : i * (total - 1) / (kept - 1));
  }
  return positions;
}

absl::Status CheckFrame(const TetMesh& mesh, const Incidence& incidence, const Frame& frame) {
  if (frame.positions.size() != mesh.rest_positions.size()) {
    return absl::InvalidArgumentError(absl::StrCat("frame ", frame.frame, " has ",
                                                   frame.positions.size(), " nodes, the mesh ",
                                                   mesh.rest_positions.size()));
  }
  for (const int32_t edge : frame.broken_edges) {
    if (edge >= 0 && edge < incidence.edge_count()) continue;
    return absl::InvalidArgumentError(absl::StrCat("frame ", frame.frame, " breaks edge ", edge,
                                                   ", the mesh has ", incidence.edge_count()));
  }
  return absl::OkStatus();
}

// Adds nodes of the frame, every one of at most kPointsAFrame, but for crumbs and nodes of no tet.
void AddPoints(const TetMesh& mesh, const Incidence& incidence, const Frame& frame,
               std::vector<Vec3>& points) {
  const Fragments fragments = FindFragments(mesh, incidence, frame.broken_edges);
  const auto most = static_cast<double>(mesh.node_count());
  const int64_t stride = std::max<int64_t>(1, mesh.node_count() / kPointsAFrame);
  for (int64_t node = 0; node < mesh.node_count(); node += stride) {
    const int32_t fragment = fragments.node_fragments[static_cast<size_t>(node)];
    if (fragment < 0) continue;
    const int32_t size = fragments.node_counts[static_cast<size_t>(fragment)];
    if (size < kLeastNodes || static_cast<double>(size) < kCrumb * most) continue;
    points.push_back(frame.positions[static_cast<size_t>(node)]);
  }
}

}  // namespace

absl::StatusOr<MotionSurvey> SurveyMotion(const TetMesh& mesh, const FrameSource& frames,
                                          int64_t most) {
  if (frames.count <= 0) return absl::InvalidArgumentError("there are no frames to draw");
  const Incidence incidence = BuildIncidence(mesh);
  MotionSurvey survey;
  survey.positions = EvenPositions(frames.count, most);
  const auto count = static_cast<int64_t>(survey.positions.size());
  const std::vector<int64_t> framed = EvenPositions(count, kPointFrames);
  size_t next_framed = 0;
  for (int64_t i = 0; i < count; ++i) {
    CLEAVE_ASSIGN_OR_RETURN(const Frame frame,
                            frames.read(survey.positions[static_cast<size_t>(i)]));
    CLEAVE_RETURN_IF_ERROR(CheckFrame(mesh, incidence, frame));
    survey.times.push_back(frame.time);
    survey.broken_edges.push_back(static_cast<int64_t>(frame.broken_edges.size()));
    if (next_framed < framed.size() && framed[next_framed] == i) {
      ++next_framed;
      AddPoints(mesh, incidence, frame, survey.points);
    }
  }
  // All in crumbs from the first frame on: then they are what there is to see.
  if (survey.points.empty()) survey.points = mesh.rest_positions;
  return survey;
}

std::vector<int64_t> ChooseFrames(const MotionSurvey& survey, int count) {
  const size_t total = survey.positions.size();
  if (total <= static_cast<size_t>(std::max(count, 1))) return survey.positions;
  if (count <= 1) return {survey.positions.back()};
  const auto broken = static_cast<double>(survey.broken_edges.back());
  std::vector<double> steps(total, 0.0);  // how much happens from the frame before to this one
  for (size_t i = 1; i < total; ++i) {
    const auto torn = static_cast<double>(survey.broken_edges[i] - survey.broken_edges[i - 1]);
    steps[i] = 1 / static_cast<double>(total - 1) + (broken > 0 ? std::max(torn, 0.0) / broken : 0);
  }
  // A step that is worth more than one picture gets one, and the rest goes to the others.
  for (int round = 0; round < 20; ++round) {
    const double cap = std::accumulate(steps.begin(), steps.end(), 0.0) / (count - 1);
    for (double& step : steps) step = std::min(step, cap);
  }
  std::vector<double> progress(total);  // from 0 to 1
  std::partial_sum(steps.begin(), steps.end(), progress.begin());
  const double all = progress.back();
  for (double& value : progress) value /= all;
  std::vector<int64_t> chosen;
  size_t next = 0;
  for (int k = 0; k < count; ++k) {
    const double wanted = static_cast<double>(k) / (count - 1);
    // Enough frames stay for the pictures to come.
    const size_t last = total - static_cast<size_t>(count - k);
    while (next < last && progress[next] < wanted - 1e-9) ++next;
    chosen.push_back(survey.positions[next]);
    ++next;
  }
  return chosen;
}

}  // namespace cleave

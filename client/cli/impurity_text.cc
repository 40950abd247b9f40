#include "client/cli/impurity_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/mesh_text.h"
#include "client/io/export/vtu.h"
#include "core/picture/impurity_picture.h"

namespace cleave {
namespace {

std::string StrengthText(double strength, bool relative) {
  if (std::isinf(strength)) return "unbreakable";
  if (strength == 0) return "cut";
  return relative ? absl::StrFormat("%.4g of the pure body's", strength)
                  : absl::StrFormat("%.4g Pa", strength);
}

std::vector<double> Finite(const google::protobuf::RepeatedField<double>& values) {
  std::vector<double> finite(values.begin(), values.end());
  for (double& value : finite) value = std::min(value, std::numeric_limits<double>::max());
  return finite;
}

}  // namespace

std::string ImpurityText(const v1::PreviewImpurityResponse& preview, bool relative) {
  double least = preview.potencies_size() > 0 ? preview.potencies(0) : 0, most = least;
  int64_t impure = 0;
  for (const double potency : preview.potencies()) {
    least = std::min(least, potency);
    most = std::max(most, potency);
    impure += potency != 0;
  }
  const double share = preview.edge_count() > 0 ? static_cast<double>(preview.affected_edges()) /
                                                      static_cast<double>(preview.edge_count())
                                                : 0;
  return absl::StrCat(absl::StrFormat("nodes: %d, %d of them impure; potency %.4g to %.4g\n",
                                      preview.potencies_size(), impure, least, most),
                      absl::StrFormat("edges: %d, %d of them affected (%.2f %%)\n",
                                      preview.edge_count(), preview.affected_edges(), 100 * share),
                      "strength: ", StrengthText(preview.weakest(), relative), " to ",
                      StrengthText(preview.strongest(), relative));
}

std::vector<double> ShownImpurities(const v1::PreviewImpurityResponse& preview) {
  std::vector<std::array<int32_t, 2>> edges;
  for (int edge = 0; edge < preview.weakenings_size(); ++edge)
    edges.push_back({preview.edge_nodes(2 * edge), preview.edge_nodes(2 * edge + 1)});
  const auto span = [](const google::protobuf::RepeatedField<double>& values) {
    return std::span<const double>(values.data(), static_cast<size_t>(values.size()));
  };
  return ImpurityShares(span(preview.potencies()), edges, span(preview.weakenings()));
}

absl::StatusOr<std::string> PotencyVtu(const TetMesh& mesh,
                                       const v1::PreviewImpurityResponse& preview) {
  VtuGrid grid = TetGrid(mesh);
  const std::vector<double> potencies(preview.potencies().begin(), preview.potencies().end());
  const std::vector<double> shown = ShownImpurities(preview);
  grid.point_data = {MakeVtuArray<double>("potency", potencies),
                     MakeVtuArray<double>("impurity", shown)};
  return EncodeVtu(grid, "impurities at rest");
}

absl::StatusOr<std::string> AffectedEdgesVtu(const TetMesh& mesh,
                                             const v1::PreviewImpurityResponse& preview) {
  VtuGrid grid;
  grid.points = mesh.rest_positions;
  grid.connectivity.assign(preview.edge_nodes().begin(), preview.edge_nodes().end());
  for (int edge = 1; edge <= preview.weakenings_size(); ++edge) grid.offsets.push_back(2 * edge);
  grid.types.assign(grid.offsets.size(), kVtuLine);
  const std::vector<double> weakenings = Finite(preview.weakenings());
  const std::vector<double> strengths = Finite(preview.strengths());
  grid.cell_data = {MakeVtuArray<double>("weakening", weakenings),
                    MakeVtuArray<double>("strength", strengths)};
  return EncodeVtu(grid, "edges that impurities affect");
}

}  // namespace cleave

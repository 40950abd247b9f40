#include "core/picture/impurity_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/boundary_faces.h"
#include "core/picture/legend.h"
#include "core/picture/palette.h"
#include "core/picture/render.h"
#include "core/picture/shown_surface.h"
#include "core/picture/text.h"

namespace cleave {
namespace {

// The boundary of the mesh, with its nodes as points.
ShownSurface BoundaryOf(const TetMesh& mesh, std::span<const double> impurities) {
  ShownSurface surface;
  std::vector<int32_t> nodes(mesh.rest_positions.size()), points(mesh.rest_positions.size(), -1);
  std::iota(nodes.begin(), nodes.end(), 0);
  for (const BoundaryFace& face : FindBoundaryFaces(mesh, nodes)) {
    std::array<int32_t, 3>& triangle = surface.triangles.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const auto node = static_cast<size_t>(face.nodes[k]);
      if (points[node] < 0) {
        points[node] = static_cast<int32_t>(surface.points.size());
        surface.points.push_back(mesh.rest_positions[node]);
        surface.impurities.push_back(static_cast<float>(impurities[node]));
      }
      triangle[k] = points[node];
    }
  }
  surface.pieces.assign(surface.triangles.size(), 0);
  surface.inside.assign(surface.triangles.size(), 0);
  surface.regions.assign(surface.triangles.size(), 0);
  return surface;
}

}  // namespace

Faults CheckImpurityPicture(const ImpurityPictureOptions& options, int max_width) {
  constexpr int kMinWidth = 16;
  Faults faults;
  if (options.width < kMinWidth || options.width > max_width) {
    faults.Error("width", absl::StrCat(options.width, " is outside [", kMinWidth, ", ", max_width,
                                       "] pixels"));
  }
  faults.Append("", CheckCameraOptions(options.camera));
  return faults;
}

std::vector<double> ImpurityShares(std::span<const double> potencies,
                                   std::span<const std::array<int32_t, 2>> edges,
                                   std::span<const double> weakenings) {
  double most = 0;
  for (const double potency : potencies) most = std::max(most, std::abs(potency));
  std::vector<double> shares;
  shares.reserve(potencies.size());
  for (const double potency : potencies) shares.push_back(most > 0 ? std::abs(potency) / most : 0);
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    const double change = 1 - std::min(weakenings[edge], 1 / weakenings[edge]);
    for (const int32_t node : edges[edge]) {
      double& share = shares[static_cast<size_t>(node)];
      share = std::max(share, change);
    }
  }
  return shares;
}

absl::StatusOr<Image> RenderImpurities(const TetMesh& mesh, std::span<const double> impurities,
                                       const ImpurityPictureOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckImpurityPicture(options, kMaxImageSide).ToStatus());
  if (static_cast<int64_t>(impurities.size()) != mesh.node_count()) {
    return absl::InvalidArgumentError(absl::StrCat("impurities: has ", impurities.size(),
                                                   " shares; the mesh has ", mesh.node_count(),
                                                   " nodes"));
  }
  const ShownSurface surface = BoundaryOf(mesh, impurities);
  CLEAVE_ASSIGN_OR_RETURN(const double natural, NaturalAspect(surface.points, options.camera));
  const int height =
      std::clamp(static_cast<int>(std::lround(options.width / natural)), 16, kMaxImageSide);
  CLEAVE_ASSIGN_OR_RETURN(
      const Camera camera,
      FrameCamera(surface.points, static_cast<double>(options.width) / height, options.camera));
  CLEAVE_ASSIGN_OR_RETURN(Renderer renderer, Renderer::Create());
  RenderStyle style;
  style.color_by = ColorBy::kImpurity;
  style.samples = options.samples;
  CLEAVE_ASSIGN_OR_RETURN(Image image,
                          renderer.Render(surface, camera, style, options.width, height));
  const double size = std::clamp(options.width / 70.0, 7.0, 40.0);
  const double margin = 1.3 * size;
  const TextStyle bold{.height = 1.15 * size, .pen = 0.18};
  if (!options.title.empty()) DrawText(options.title, margin, margin + size, bold, image);
  Legend legend;
  legend.swatches = {{options.low, ImpurityColor(0)}, {options.high, ImpurityColor(1)}};
  const double width = LegendWidth(legend, 0.85 * size);
  const bool fits = options.title.empty() ||
                    margin + TextWidth(options.title, bold) + width + 2 * margin < options.width;
  DrawLegend(legend, options.width - margin - width, margin + size + (fits ? 0 : 2.2 * size),
             0.85 * size, image);
  return image;
}

}  // namespace cleave

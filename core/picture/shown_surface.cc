#include "core/picture/shown_surface.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"

namespace cleave {
namespace {

void CheckSize(absl::string_view name, size_t size, size_t wanted, bool may_be_empty,
               Faults& faults) {
  if (size == wanted || (may_be_empty && size == 0)) return;
  faults.Error(name, absl::StrCat("has ", size, " items, not ", wanted));
}

void CheckFinite(absl::string_view name, const std::vector<Vec3>& vectors, Faults& faults) {
  for (size_t i = 0; i < vectors.size(); ++i) {
    for (const double value : vectors[i]) {
      if (std::isfinite(value)) continue;
      faults.Error(absl::StrCat(name, "[", i, "]"), absl::StrCat(value, " is not a finite number"));
      return;
    }
  }
}

void CheckFinite(absl::string_view name, const std::vector<float>& values, Faults& faults) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    faults.Error(absl::StrCat(name, "[", i, "]"),
                 absl::StrCat(values[i], " is not a finite number"));
    return;
  }
}

}  // namespace

absl::Status CheckShownSurface(const ShownSurface& surface) {
  Faults faults;
  const size_t points = surface.points.size();
  const size_t triangles = surface.triangles.size();
  if (!std::isfinite(surface.time)) {
    faults.Error("time", absl::StrCat(surface.time, " is not a finite number"));
  }
  CheckSize("pieces", surface.pieces.size(), triangles, false, faults);
  CheckSize("inside", surface.inside.size(), triangles, false, faults);
  CheckSize("regions", surface.regions.size(), triangles, false, faults);
  CheckSize("uvs", surface.uvs.size(), triangles, true, faults);
  CheckSize("sources", surface.sources.size(), triangles, true, faults);
  CheckSize("strains", surface.strains.size(), points, true, faults);
  CheckSize("damages", surface.damages.size(), points, true, faults);
  CheckSize("potencies", surface.potencies.size(), points, true, faults);
  CheckSize("impurities", surface.impurities.size(), points, true, faults);
  CheckSize("rest_points", surface.rest_points.size(), points, true, faults);
  CheckSize("displacements", surface.displacements.size(), points, true, faults);
  CheckSize("velocities", surface.velocities.size(), points, true, faults);
  CheckFinite("points", surface.points, faults);
  CheckFinite("displacements", surface.displacements, faults);
  CheckFinite("velocities", surface.velocities, faults);
  CheckFinite("strains", surface.strains, faults);
  CheckFinite("damages", surface.damages, faults);
  CheckFinite("potencies", surface.potencies, faults);
  CheckFinite("impurities", surface.impurities, faults);
  CheckFinite("rest_points", surface.rest_points, faults);
  for (size_t i = 0; i < triangles; ++i) {
    for (const int32_t point : surface.triangles[i]) {
      if (point >= 0 && static_cast<size_t>(point) < points) continue;
      faults.Error(absl::StrCat("triangles[", i, "]"),
                   absl::StrCat("point ", point, " is outside [0, ", points, ")"));
      return faults.ToStatus();
    }
  }
  return faults.ToStatus();
}

}  // namespace cleave

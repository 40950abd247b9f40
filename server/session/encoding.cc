#include "server/session/encoding.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/sha256.h"

namespace cleave {

absl::StatusOr<worker::v1::Encoding> EncodingOfRung(Rung rung, bool surface,
                                                    const StreamHeader& kept) {
  const absl::StatusOr<RungChoice> choice = SnapDown(rung, kept);
  if (!choice.ok() || choice->as_kept || choice->rung != rung)
    return absl::InvalidArgumentError(absl::StrCat("the session's frames, kept at ", kept.tolerance,
                                                   " m, have no coarser rung \"", RungName(rung),
                                                   "\""));
  worker::v1::Encoding encoding;
  encoding.set_name(absl::StrCat(surface ? "surface-" : "", RungName(rung)));
  encoding.set_tolerance(ToleranceOfAnew(rung, kept));
  encoding.set_surface(surface);
  return encoding;
}

worker::v1::Encoding EncodingOfRegion(const v1::RegionOfInterest& region, double inside,
                                      double outside, bool surface, const StreamHeader& kept) {
  worker::v1::Encoding encoding;
  encoding.set_tolerance(inside - kept.tolerance);
  encoding.set_surface(surface);
  std::vector<int32_t> nodes(region.nodes().begin(), region.nodes().end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  encoding.mutable_region()->mutable_nodes()->Add(nodes.begin(), nodes.end());
  if (region.has_box()) *encoding.mutable_region()->mutable_box() = region.box();
  const int power = std::ilogb((outside - kept.tolerance) / encoding.tolerance());
  encoding.mutable_region()->set_outside_tolerance(std::ldexp(encoding.tolerance(), power));
  encoding.set_name(
      absl::StrCat(kRegionPrefix,
                   absl::BytesToHexString(Sha256::Of(encoding.SerializeAsString())).substr(0, 16)));
  return encoding;
}

std::optional<Region> RegionOf(const worker::v1::Encoding& encoding) {
  if (!encoding.has_region()) return std::nullopt;
  const v1::RegionOfInterest& message = encoding.region();
  Region region;
  region.nodes.assign(message.nodes().begin(), message.nodes().end());
  region.outside_tolerance = message.outside_tolerance();
  if (!message.has_box()) return region;
  std::array<Vec3, 2>& box = region.box.emplace();
  std::copy_n(message.box().min().begin(), 3, box[0].begin());
  std::copy_n(message.box().max().begin(), 3, box[1].begin());
  return region;
}

}  // namespace cleave

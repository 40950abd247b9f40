#include "server/gateway/frame_choice.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/stream/region.h"
#include "proto/convert/rung.h"
#include "server/gateway/errors.h"
#include "server/session/encoding.h"

namespace cleave {
namespace {

constexpr int kMaxRegionNodes = 1000;  // so that a worker's arguments have room for them
constexpr double kMaxTolerance = 1e9;  // m, of a stream

absl::Status FinerThanKept(const v1::StreamFramesRequest& request, absl::string_view why) {
  return MakeError(absl::StatusCode::kFailedPrecondition, "FINER_THAN_KEPT",
                   absl::StrCat(request.has_rung() ? "rung: " : "tolerance: ", why,
                                "; a session that is created with a finer rung or "
                                "scene.output.tolerance keeps them"));
}

bool WantsSurface(const v1::StreamFramesRequest& request) {
  return request.view() == v1::FRAME_VIEW_SURFACE;
}

void CheckRegion(const v1::RegionOfInterest& region, Faults& faults) {
  if (region.nodes().empty() && !region.has_box()) {
    faults.Error("region", "has neither nodes nor a box");
  }
  if (region.nodes_size() > kMaxRegionNodes) {
    faults.Error("region.nodes",
                 absl::StrCat(region.nodes_size(), " is more than ", kMaxRegionNodes));
  }
  if (region.has_box()) {
    const auto& low = region.box().min();
    const auto& high = region.box().max();
    if (low.size() != 3 || high.size() != 3) {
      faults.Error("region.box", "min and max have three coordinates each");
    } else {
      std::array<Vec3, 2> box{};
      std::copy(low.begin(), low.end(), box[0].begin());
      std::copy(high.begin(), high.end(), box[1].begin());
      CheckBox("region.box", box, faults);
    }
  }
  if (region.has_outside_rung() && !RungFromMessage(region.outside_rung()).has_value()) {
    faults.Error("region.outside_rung",
                 absl::StrCat(static_cast<int>(region.outside_rung()), " is no rung"));
  }
}

absl::StatusOr<FrameChoice> ChooseRegion(const v1::StreamFramesRequest& request,
                                         std::optional<double> asked, const StreamHeader& kept) {
  const double coarsest = RungTolerance(Rung::kPreview, kept.diagonal());
  FrameChoice choice;
  choice.tolerance =
      kept.tolerance > 0 ? 2 * kept.tolerance : RungTolerance(Rung::kStandard, kept.diagonal());
  if (asked.has_value()) choice.tolerance = *asked;
  if (!(choice.tolerance >= 2 * kept.tolerance && choice.tolerance > 0)) {
    return FinerThanKept(request,
                         absl::StrCat(choice.tolerance, " m in a region is below twice the ",
                                      kept.tolerance, " m at which the frames are kept, or 0"));
  }
  const v1::RegionOfInterest& region = request.region();
  const std::optional<Rung> outside = RungFromMessage(region.outside_rung());
  choice.outside_tolerance = region.has_outside_tolerance() ? region.outside_tolerance()
                             : outside.has_value() ? RungTolerance(*outside, kept.diagonal())
                                                   : std::max(coarsest, 2 * choice.tolerance);
  Faults faults;
  if (!(choice.outside_tolerance >= 2 * choice.tolerance &&
        choice.outside_tolerance <= kMaxTolerance)) {
    faults.Error(region.has_outside_rung() ? "region.outside_rung" : "region.outside_tolerance",
                 absl::StrCat(choice.outside_tolerance, " m is outside [", 2 * choice.tolerance,
                              ", ", kMaxTolerance, "], twice what holds inside or more"));
  }
  for (int at = 0; at < region.nodes_size(); ++at) {
    const int64_t node = region.nodes(at);
    if (node >= 0 && node < static_cast<int64_t>(kept.node_count)) continue;
    faults.Error(absl::StrCat("region.nodes[", at, "]"),
                 absl::StrCat(node, " is outside [0, ", kept.node_count, ")"));
  }
  if (!faults.ok()) return MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
  for (const Rung rung : kRungs) {
    if (RungTolerance(rung, kept.diagonal()) == choice.tolerance) choice.rung = rung;
  }
  choice.encoding = EncodingOfRegion(region, choice.tolerance, choice.outside_tolerance,
                                     WantsSurface(request), kept);
  return choice;
}

absl::StatusOr<FrameChoice> ChooseSurface(const v1::StreamFramesRequest& request,
                                          std::optional<double> asked, const StreamHeader& kept) {
  FrameChoice choice;
  for (const Rung rung : kRungs) {  // from coarse to fine
    const double tolerance = RungTolerance(rung, kept.diagonal());
    if (tolerance <= 0 || tolerance < 2 * kept.tolerance) continue;
    choice.rung = rung;
    choice.tolerance = tolerance;
    if (asked.has_value() && tolerance <= *asked) break;
  }
  if (!choice.rung.has_value() || (asked.has_value() && choice.tolerance > *asked)) {
    return FinerThanKept(request, absl::StrCat(asked.value_or(kept.tolerance),
                                               " m in the surface view is finer than a rung at "
                                               "least twice as coarse as the ",
                                               kept.tolerance, " m at which the frames are kept"));
  }
  CLEAVE_ASSIGN_OR_RETURN(choice.encoding, EncodingOfRung(*choice.rung, /*surface=*/true, kept));
  return choice;
}

}  // namespace

void CheckFrameChoice(const v1::StreamFramesRequest& request, Faults& faults) {
  if (request.has_tolerance() && !(request.tolerance() >= 0)) {
    faults.Error("tolerance", absl::StrCat(request.tolerance(), " m is below 0"));
  }
  if (request.has_rung() && !v1::Rung_IsValid(request.rung())) {
    faults.Error("rung", absl::StrCat(static_cast<int>(request.rung()), " is no rung"));
  }
  if (!v1::FrameView_IsValid(request.view())) {
    faults.Error("view", absl::StrCat(static_cast<int>(request.view()), " is no view"));
  }
  if (request.has_region()) CheckRegion(request.region(), faults);
}

absl::StatusOr<FrameChoice> ChooseFrames(const v1::StreamFramesRequest& request,
                                         const StreamHeader& kept) {
  std::optional<double> asked;
  if (request.has_tolerance()) asked = request.tolerance();
  if (const std::optional<Rung> rung = RungFromMessage(request.rung()); rung.has_value()) {
    asked = RungTolerance(*rung, kept.diagonal());
  }
  if (request.has_region()) return ChooseRegion(request, asked, kept);
  if (WantsSurface(request)) return ChooseSurface(request, asked, kept);
  const absl::StatusOr<RungChoice> snapped = SnapDown(asked.value_or(kept.tolerance), kept);
  if (!snapped.ok()) return FinerThanKept(request, snapped.status().message());
  FrameChoice choice{.rung = snapped->rung, .tolerance = snapped->tolerance};
  if (!snapped->as_kept) {
    CLEAVE_ASSIGN_OR_RETURN(choice.encoding,
                            EncodingOfRung(*snapped->rung, /*surface=*/false, kept));
  }
  return choice;
}

}  // namespace cleave

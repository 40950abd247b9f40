#include "core/stream/rungs.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/stream/stream_header.h"

namespace cleave {
namespace {

double ToleranceOf(Rung rung, const StreamHeader& kept) {
  return RungTolerance(rung, kept.diagonal());
}

}  // namespace

absl::string_view RungName(Rung rung) {
  switch (rung) {
    case Rung::kPreview:
      return "preview";
    case Rung::kStandard:
      return "standard";
    case Rung::kFine:
      return "fine";
    case Rung::kLossless:
      return "lossless";
  }
  return "";
}

std::optional<Rung> ParseRung(absl::string_view name) {
  for (const Rung rung : kRungs)
    if (name == RungName(rung)) return rung;
  return std::nullopt;
}

double RungTolerance(Rung rung, double diagonal) {
  const double length = diagonal > 0 ? diagonal : 1;
  switch (rung) {
    case Rung::kPreview:
      return 1e-3 * length;
    case Rung::kStandard:
      return 1e-4 * length;
    case Rung::kFine:
      return 1e-5 * length;
    case Rung::kLossless:
      return 0;
  }
  return 0;
}

absl::StatusOr<RungChoice> SnapDown(double tolerance, const StreamHeader& kept) {
  if (!(tolerance >= kept.tolerance))
    return absl::OutOfRangeError(absl::StrCat("a tolerance of ", tolerance, " m is finer than the ",
                                              kept.tolerance, " m at which the frames are kept"));
  for (const Rung rung : kRungs) {
    const double coarse = ToleranceOf(rung, kept);
    if (coarse <= tolerance && coarse > kept.tolerance && coarse >= 2 * kept.tolerance)
      return RungChoice{.rung = rung, .tolerance = coarse, .as_kept = false};
  }
  RungChoice choice{.rung = std::nullopt, .tolerance = kept.tolerance, .as_kept = true};
  for (const Rung rung : kRungs)
    if (ToleranceOf(rung, kept) == kept.tolerance) choice.rung = rung;
  return choice;
}

absl::StatusOr<RungChoice> SnapDown(Rung rung, const StreamHeader& kept) {
  return SnapDown(ToleranceOf(rung, kept), kept);
}

double ToleranceOfAnew(Rung rung, const StreamHeader& kept) {
  return ToleranceOf(rung, kept) - kept.tolerance;
}

}  // namespace cleave

#ifndef CLEAVE_CORE_STREAM_RUNGS_H_
#define CLEAVE_CORE_STREAM_RUNGS_H_

#include <array>
#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

struct StreamHeader;

// The accuracies that viewers share: largest errors of a coordinate as fractions of the diagonal of
// the rest bounding box. Pure; any thread.
enum class Rung : uint8_t {
  kPreview = 1,   // 1e-3
  kStandard = 2,  // 1e-4
  kFine = 3,      // 1e-5
  kLossless = 4,  // 0: to the bit
};

// From coarse to fine.
inline constexpr std::array<Rung, 4> kRungs = {Rung::kPreview, Rung::kStandard, Rung::kFine,
                                               Rung::kLossless};

// preview, standard, fine, lossless.
absl::string_view RungName(Rung rung);
std::optional<Rung> ParseRung(absl::string_view name);

// Of a body with this diagonal (m) at rest, in metres; a body without extent counts as 1 m long.
double RungTolerance(Rung rung, double diagonal);

// How frames that are kept in one stream can be had.
struct RungChoice {
  std::optional<Rung> rung;  // absent: as kept, with a tolerance that is no rung's
  double tolerance = 0;      // m, largest error of a coordinate against the simulation
  bool as_kept = true;       // false: encoded anew from the frames that are kept
};

// What frames of the stream `kept` are given to somebody who wants an error of at most `tolerance`
// (m): the coarsest rung that holds it, or the frames as they are kept where no rung between does.
// A rung is encoded anew only where it is at least twice as coarse as what is kept: the errors of
// both encodings add up to its tolerance. Error: OutOfRange when the kept frames are coarser than
// asked.
absl::StatusOr<RungChoice> SnapDown(double tolerance, const StreamHeader& kept);
// The same for the tolerance of a rung.
absl::StatusOr<RungChoice> SnapDown(Rung rung, const StreamHeader& kept);

// What the encoder of a rung must keep to against the kept frames, m. Precondition: SnapDown chose
// the rung to be encoded anew.
double ToleranceOfAnew(Rung rung, const StreamHeader& kept);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_RUNGS_H_

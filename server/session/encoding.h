#ifndef CLEAVE_SERVER_SESSION_ENCODING_H_
#define CLEAVE_SERVER_SESSION_ENCODING_H_

#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/worker/v1/control.pb.h"
#include "core/stream/region.h"
#include "core/stream/rungs.h"
#include "core/stream/stream_header.h"

namespace cleave {

// What names of encodings with a region begin with.
inline constexpr absl::string_view kRegionPrefix = "region-";

// How a rung is encoded from frames that are kept in a stream like `kept`. Error: InvalidArgument
// when those are too coarse for it.
absl::StatusOr<worker::v1::Encoding> EncodingOfRung(Rung rung, bool surface,
                                                    const StreamHeader& kept);

// A region with these tolerances (m) against the simulation; the name follows from all of it.
// Requests whose frames would be the same give the same: nodes are sorted, and outside is as fine
// as frames can have it, a power of two times what is inside. Precondition: inside is at least
// twice kept.tolerance and above 0, outside at least twice inside.
worker::v1::Encoding EncodingOfRegion(const v1::RegionOfInterest& region, double inside,
                                      double outside, bool surface, const StreamHeader& kept);

// The region of an encoding, for its encoder.
std::optional<Region> RegionOf(const worker::v1::Encoding& encoding);

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_ENCODING_H_

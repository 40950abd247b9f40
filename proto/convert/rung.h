#ifndef CLEAVE_PROTO_CONVERT_RUNG_H_
#define CLEAVE_PROTO_CONVERT_RUNG_H_

#include <optional>

#include "cleave/v1/frame.pb.h"
#include "core/stream/rungs.h"

namespace cleave {

static_assert(static_cast<int>(Rung::kPreview) == v1::RUNG_PREVIEW &&
              static_cast<int>(Rung::kStandard) == v1::RUNG_STANDARD &&
              static_cast<int>(Rung::kFine) == v1::RUNG_FINE &&
              static_cast<int>(Rung::kLossless) == v1::RUNG_LOSSLESS);

// Nothing for RUNG_UNSPECIFIED and for what this build does not know.
inline std::optional<Rung> RungFromMessage(v1::Rung message) {
  for (const Rung rung : kRungs)
    if (static_cast<int>(rung) == static_cast<int>(message)) return rung;
  return std::nullopt;
}

inline v1::Rung RungMessage(std::optional<Rung> rung) {
  return rung.has_value() ? static_cast<v1::Rung>(*rung) : v1::RUNG_UNSPECIFIED;
}

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_RUNG_H_

#ifndef CLEAVE_CORE_STREAM_SECTION_CODER_H_
#define CLEAVE_CORE_STREAM_SECTION_CODER_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// Coder 1 of FORMAT.md: raw bytes in equal parts, each stored or one zstd frame, whichever is
// shorter. `parts` divides the size of `raw`.
std::string CodeParts(absl::string_view raw, uint32_t parts);

// The reverse, into exactly raw.size() bytes. Allocates nothing that the coded bytes name. Errors:
// DataLoss.
absl::Status DecodeParts(absl::string_view coded, uint32_t parts, std::span<char> raw);

// Residuals of n nodes (x, y, z of each) to byte planes: zigzag, then for each plane, lowest first,
// the bytes of all x, all y, all z. As many planes as the largest residual needs, possibly none.
std::string ToBytePlanes(std::span<const int32_t> residuals);
std::string ToBytePlanes(std::span<const int64_t> residuals);

// The reverse; `planes` are 3 * nodes bytes each, at most as many as a residual has bytes.
void FromBytePlanes(absl::string_view planes, std::span<int32_t> residuals);
void FromBytePlanes(absl::string_view planes, std::span<int64_t> residuals);

// Ascending ids as LEB128 of the gaps, the first counted from -1.
std::string ToGaps(std::span<const int32_t> ids);

// The reverse: exactly `count` ids, ascending, from `first` up to below `end`. Errors: DataLoss.
absl::Status FromGaps(absl::string_view bytes, uint32_t count, int64_t first, int64_t end,
                      std::vector<int32_t>& ids);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_SECTION_CODER_H_

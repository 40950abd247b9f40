#include "core/stream/frame_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/bytes.h"
#include "core/base/status.h"
#include "core/stream/section_coder.h"

namespace cleave {
namespace {

constexpr uint8_t kSomeHold = 1;
constexpr uint8_t kHasClasses = 2;
constexpr uint8_t kSomeAreCoarse = 4;

constexpr auto kListed = static_cast<uint8_t>(kNamedContinuations.size());

size_t LargestMotion(int64_t pieces, int64_t groups) {
  return 2 + 2 * ((static_cast<size_t>(pieces) + 7) / 8) + 8 * static_cast<size_t>(groups);
}

// A bit for each piece, the first lowest.
void PutBits(const std::vector<uint8_t>& flags, ByteWriter& writer) {
  for (size_t piece = 0; piece < flags.size(); piece += 8) {
    unsigned bits = 0;
    for (size_t bit = 0; bit < std::min<size_t>(8, flags.size() - piece); ++bit) {
      bits |= unsigned{flags[piece + bit]} << bit;
    }
    writer.Put(static_cast<uint8_t>(bits));
  }
}

// The reverse; false if what fills the last byte is not zero.
bool GetBits(ByteReader& reader, int64_t pieces, std::vector<uint8_t>& flags) {
  bool fits = true;
  flags.resize(static_cast<size_t>(pieces));
  for (size_t piece = 0; piece < flags.size(); piece += 8) {
    const unsigned bits = reader.Get<uint8_t>();
    const size_t there = std::min<size_t>(8, flags.size() - piece);
    for (size_t bit = 0; bit < there; ++bit) flags[piece + bit] = bits >> bit & 1;
    fits &= bits >> there == 0;
  }
  return fits;
}

}  // namespace

void AppendMotion(bool key, const FrameMotion& motion, int64_t groups, FrameHeader& header,
                  std::string& body) {
  std::string raw;
  ByteWriter writer(raw);
  writer.Put<uint8_t>(static_cast<uint8_t>((motion.held.empty() ? 0 : kSomeHold) |
                                           (motion.classes.empty() ? 0 : kHasClasses) |
                                           (motion.coarse.empty() ? 0 : kSomeAreCoarse)));
  PutBits(motion.held, writer);
  if (!motion.coarse.empty()) writer.Put(motion.shift);
  PutBits(motion.coarse, writer);
  if (!key) {
    for (const Continuation& by : motion.continuations) {
      const auto named = std::find(kNamedContinuations.begin(), kNamedContinuations.end(), by);
      writer.Put(static_cast<uint8_t>(named - kNamedContinuations.begin()));
      if (named != kNamedContinuations.end()) continue;
      writer.Put(static_cast<int16_t>(by.last));
      writer.Put(static_cast<int16_t>(by.before));
      writer.Put(static_cast<int16_t>(by.rest));
    }
  }
  for (const uint8_t group_class : motion.classes) writer.Put(group_class);
  const std::string coded = CodeParts(raw, 1);
  AppendSection({.type = SectionType::kMotion,
                 .coder = kCoderZstdPlanes,
                 .raw_bytes = static_cast<uint32_t>(raw.size()),
                 .count = static_cast<uint32_t>(groups),
                 .coded = coded},
                body);
  ++header.section_count;
}

absl::StatusOr<FrameMotion> ReadMotion(bool key, const StreamHeader& stream, const Section& section,
                                       int64_t pieces, int64_t groups) {
  const bool rans = stream.coder_id == kCoderContextRans;
  if (section.type != SectionType::kMotion || section.coder != kCoderZstdPlanes ||
      section.prediction != Prediction::kNone || section.first != 0 || section.count != groups ||
      section.raw_bytes == 0 || section.raw_bytes > LargestMotion(pieces, groups)) {
    return absl::DataLossError("motion section does not fit its frame");
  }
  std::string raw(section.raw_bytes, '\0');
  CLEAVE_RETURN_IF_ERROR(DecodeParts(section.coded, 1, raw));
  ByteReader reader(raw);
  FrameMotion motion;
  const auto flags = reader.Get<uint8_t>();
  const bool some_hold = (flags & kSomeHold) != 0;
  const bool has_classes = (flags & kHasClasses) != 0;
  const int known = kSomeHold | kHasClasses | (stream.has_regions() ? kSomeAreCoarse : 0);
  bool fits = (flags & ~known) == 0 && !(key && some_hold) && (has_classes ? rans : !(key && rans));
  if (some_hold) fits &= GetBits(reader, pieces, motion.held);
  if (fits && (flags & kSomeAreCoarse) != 0) {
    motion.shift = reader.Get<uint8_t>();
    fits &= motion.shift >= 1 && motion.shift <= kMaxShift;
    fits &= GetBits(reader, pieces, motion.coarse);
  }
  motion.continuations.assign(static_cast<size_t>(groups), kFromRest);
  if (!key) {
    for (Continuation& by : motion.continuations) {
      const auto choice = reader.Get<uint8_t>();
      if (choice < kListed) {
        by = kNamedContinuations[choice];
        continue;
      }
      by.last = reader.Get<int16_t>();
      by.before = reader.Get<int16_t>();
      by.rest = reader.Get<int16_t>();
      fits &= choice == kListed && std::abs(by.last) <= kMaxContinuation &&
              std::abs(by.before) <= kMaxContinuation && std::abs(by.rest) <= kMaxContinuation;
    }
  }
  if (has_classes) {
    for (int64_t group = 0; group < groups; ++group) {
      motion.classes.push_back(reader.Get<uint8_t>());
      fits &= motion.classes.back() < kClasses || (motion.classes.back() == kGoesOn && !key);
    }
  }
  CLEAVE_RETURN_IF_ERROR(reader.Finish("motion section"));
  if (!fits) return absl::DataLossError("motion section has values out of range");
  return motion;
}

void BeginResiduals(bool key, const NodeOrder& order, const FrameMotion& motion,
                    const ResidualHistory& history, ResidualHistory& next) {
  next.activities = history.activities;
  next.activities.resize(order.nodes.size());
  for (size_t group = 0; group < motion.classes.size(); ++group) {
    if (motion.classes[group] == kGoesOn) continue;
    std::fill(next.activities.begin() + order.group_begins[group],
              next.activities.begin() + order.group_begins[group + 1],
              ActivityOf(motion.classes[group]));
  }
  next.counts = key ? PriorCounts() : history.counts;
  next.counts.Fade();
}

}  // namespace cleave

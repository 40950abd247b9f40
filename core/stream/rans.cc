#include "core/stream/rans.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/base/bytes.h"

namespace cleave {

void RansWriter::Clear() {
  symbols_.clear();
  plain_.clear();
  pending_ = 0;
  pending_count_ = 0;
}

void RansWriter::PutBits(uint32_t bits, uint32_t count) {
  pending_ |= uint64_t{bits} << pending_count_;
  pending_count_ += count;
  for (; pending_count_ >= 8; pending_count_ -= 8) {
    plain_.push_back(static_cast<char>(pending_ & 0xFF));
    pending_ >>= 8;
  }
}

std::string RansWriter::Finish() {
  // From the last symbol to the first, because the reader takes them off in the other direction.
  words_.clear();
  std::array<uint32_t, kRansStates> states;
  states.fill(kRansLow);
  for (size_t at = symbols_.size(); at-- > 0;) {
    const SymbolRange range = symbols_[at];
    uint32_t& state = states[at % kRansStates];
    if (state >= uint64_t{range.frequency} << 20) {
      words_.push_back(static_cast<uint16_t>(state));
      state >>= 16;
    }
    const uint32_t rounds = state / range.frequency;
    state = (rounds << 12) + (state - rounds * range.frequency) + range.start;
  }
  std::reverse(words_.begin(), words_.end());
  std::string coded;
  ByteWriter writer(coded);
  writer.Put(static_cast<uint32_t>(words_.size()));
  for (const uint32_t state : states) writer.Put(state);
  coded.append(reinterpret_cast<const char*>(words_.data()), words_.size() * sizeof(uint16_t));
  coded += plain_;
  if (pending_count_ > 0) coded.push_back(static_cast<char>(pending_));
  return coded;
}

RansReader::RansReader(absl::string_view coded) {
  ByteReader reader(coded);
  const auto words = reader.Get<uint32_t>();
  for (uint32_t& state : states_) {
    state = reader.Get<uint32_t>();
    ok_ &= state >= kRansLow;
  }
  const absl::string_view bytes = reader.GetBytes(uint64_t{words} * sizeof(uint16_t));
  ok_ &= reader.ok();
  words_ = bytes.data();
  words_left_ = bytes.size() / sizeof(uint16_t);
  plain_ = reader.GetBytes(reader.left());
}

uint32_t RansReader::NextWord() {
  if (words_left_ == 0) {
    ok_ = false;
    return 0;
  }
  uint16_t word = 0;
  std::memcpy(&word, words_, sizeof(word));
  words_ += sizeof(word);
  --words_left_;
  return word;
}

uint32_t RansReader::NextByte() {
  if (plain_.empty()) {
    ok_ = false;
    return 0;
  }
  const auto byte = static_cast<unsigned char>(plain_.front());
  plain_.remove_prefix(1);
  return byte;
}

bool RansReader::Finish() const {
  bool ends = ok_ && words_left_ == 0 && plain_.empty() && pending_ == 0;
  for (const uint32_t state : states_) ends &= state == kRansLow;
  return ends;
}

}  // namespace cleave

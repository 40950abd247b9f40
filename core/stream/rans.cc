#include "core/stream/rans.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/base/bytes.h"

namespace cleave {

void RansWriter::Clear() {
  count_ = 0;
  plain_.clear();
  pending_ = 0;
  pending_count_ = 0;
}

uint16_t* RansWriter::MoreSymbols(size_t most) {
  if (symbols_.size() < count_ + most) symbols_.resize(count_ + most);
  return symbols_.data() + count_;
}

void RansWriter::FlushWord() {
  for (int byte = 0; byte < 4; ++byte) {
    plain_.push_back(static_cast<char>(pending_ >> (8 * byte)));
  }
  pending_ >>= 32;
  pending_count_ -= 32;
}

std::string RansWriter::Finish(std::span<const RansSymbol> table) {
  // From the last symbol to the first, because the reader takes them off in the other direction.
  // Words fill their room from the end; each symbol gives off one at most.
  if (words_.size() < count_) words_.resize(count_);
  uint16_t* const words_end = words_.data() + count_;
  uint16_t* words = words_end;
  std::array<uint32_t, kRansStates> states;
  states.fill(kRansLow);
  const auto put = [&](size_t at, uint32_t& state) {
    const RansSymbol& symbol = table[symbols_[at]];
    if (state >= symbol.limit) {
      *--words = static_cast<uint16_t>(state);
      state >>= 16;
    }
    const auto rounds = static_cast<uint32_t>(
        (static_cast<unsigned __int128>(uint64_t{state} << 1) * symbol.reciprocal) >> 64);
    state += rounds * symbol.complement + symbol.start;
  };
  size_t left = count_;
  for (; left % kRansStates != 0; --left) put(left - 1, states[(left - 1) % kRansStates]);
  auto [s0, s1, s2, s3] = states;
  for (; left > 0; left -= kRansStates) {
    put(left - 1, s3);
    put(left - 2, s2);
    put(left - 3, s1);
    put(left - 4, s0);
  }
  const auto word_count = static_cast<size_t>(words_end - words);
  std::string coded;
  coded.reserve(20 + 2 * word_count + plain_.size() + 8);
  ByteWriter writer(coded);
  writer.Put(static_cast<uint32_t>(word_count));
  for (const uint32_t state : {s0, s1, s2, s3}) writer.Put(state);
  coded.append(reinterpret_cast<const char*>(words), word_count * sizeof(uint16_t));
  coded += plain_;
  for (uint32_t bit = 0; bit < pending_count_; bit += 8) {
    coded.push_back(static_cast<char>(pending_ >> bit));
  }
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

void RansReader::Refill(uint32_t count) {
  while (pending_count_ < count) {
    if (plain_.empty()) {
      ok_ = false;
      pending_count_ = count;
      return;
    }
    if (plain_.size() >= sizeof(uint32_t)) {
      uint32_t word = 0;
      std::memcpy(&word, plain_.data(), sizeof(word));
      pending_ |= uint64_t{word} << pending_count_;
      pending_count_ += 32;
      plain_.remove_prefix(sizeof(word));
    } else {
      pending_ |= uint64_t{static_cast<unsigned char>(plain_.front())} << pending_count_;
      pending_count_ += 8;
      plain_.remove_prefix(1);
    }
  }
}

bool RansReader::Finish() const {
  // Bits are taken off the stream four bytes at a time; what was not asked for must be less than a
  // byte, of zeros.
  bool ends = ok_ && words_left_ == 0 && plain_.empty() && pending_ == 0 && pending_count_ < 8;
  for (const uint32_t state : states_) ends &= state == kRansLow;
  return ends;
}

}  // namespace cleave

#ifndef CLEAVE_CORE_BASE_BYTES_H_
#define CLEAVE_CORE_BASE_BYTES_H_

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace cleave {

static_assert(std::endian::native == std::endian::little, "the formats are little-endian");

// Appends little-endian values to a string.
class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  template <typename T>
  void Put(T value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    out_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void PutBytes(absl::string_view bytes) { out_.append(bytes.data(), bytes.size()); }
  // A 64-bit count, then the items as they lie in memory.
  template <typename T>
  void PutVector(const std::vector<T>& items) {
    static_assert(std::is_trivially_copyable_v<T>);
    Put<uint64_t>(items.size());
    out_.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T));
  }

 private:
  std::string& out_;
};

// Reads what ByteWriter wrote, from bytes that nobody vouches for: a short or lying input makes
// ok() false and every later value zero or empty, and never allocates more than the input holds.
class ByteReader {
 public:
  explicit ByteReader(absl::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  size_t left() const { return bytes_.size(); }

  template <typename T>
  T Get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    if (!ok_ || bytes_.size() < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    return value;
  }
  absl::string_view GetBytes(uint64_t size) {
    if (!ok_ || size > bytes_.size()) {
      ok_ = false;
      return {};
    }
    const absl::string_view piece = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return piece;
  }
  template <typename T>
  std::vector<T> GetVector() {
    const uint64_t count = Get<uint64_t>();
    if (!ok_ || count > bytes_.size() / sizeof(T)) {
      ok_ = false;
      return {};
    }
    std::vector<T> items(count);
    if (count > 0) std::memcpy(items.data(), bytes_.data(), count * sizeof(T));
    bytes_.remove_prefix(count * sizeof(T));
    return items;
  }
  // OK when everything was there and nothing is left over.
  absl::Status Finish(absl::string_view what) const {
    if (!ok_) return absl::DataLossError(absl::StrCat(what, " is truncated"));
    if (!bytes_.empty())
      return absl::DataLossError(absl::StrCat(what, " has ", bytes_.size(), " bytes too many"));
    return absl::OkStatus();
  }

 private:
  absl::string_view bytes_;
  bool ok_ = true;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_BYTES_H_

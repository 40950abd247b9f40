#ifndef CLEAVE_CORE_BASE_SHA256_H_
#define CLEAVE_CORE_BASE_SHA256_H_

#include <memory>
#include <string>

#include "absl/strings/string_view.h"

struct evp_md_ctx_st;

namespace cleave {

// SHA-256 of bytes that come in pieces; it names assets. Not thread-safe.
class Sha256 {
 public:
  Sha256();
  void Update(absl::string_view bytes);
  // The 32 raw bytes. Call once, at the end.
  std::string Digest();

  static std::string Of(absl::string_view bytes);

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_SHA256_H_

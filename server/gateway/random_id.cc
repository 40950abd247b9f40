#include "server/gateway/random_id.h"

#include <random>

#include "absl/strings/str_format.h"

namespace cleave {

std::string NewUid() {
  std::random_device device;
  return absl::StrFormat("%08x%08x%08x%08x", device(), device(), device(), device());
}

}  // namespace cleave

#include "client/cli/bounded_stop.h"

#include <cstdlib>

#include "absl/status/status.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"

namespace cleave {

BoundedStop::BoundedStop(Interrupt& interrupt, std::chrono::milliseconds patience)
    : interrupt_(interrupt), patience_(patience) {
  interrupt_.SetHandler([this](int signal, int) {
    interrupt_.stop().Request();
    std::unique_lock<std::mutex> lock(mutex_);
    if (over_.wait_for(lock, patience_, [this] { return is_over_; })) return;
    PrintNote("stopped within a frame; what was finished before stays");
    std::_Exit(static_cast<int>(ExitCodeOf(absl::CancelledError(""), signal)));
  });
}

BoundedStop::~BoundedStop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  over_.notify_all();
  interrupt_.SetHandler(nullptr);
}

}  // namespace cleave

#include "client/cli/interrupt.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "absl/status/status.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"

namespace cleave {
namespace {

sigset_t Watched() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&set, number);
  return set;
}

[[noreturn]] void CutOff(int signal) {
  PrintNote("stopped in the middle of its work; files that were finished stay");
  std::_Exit(static_cast<int>(ExitCodeOf(absl::CancelledError(""), signal)));
}

}  // namespace

Interrupt::Interrupt(std::chrono::milliseconds patience) : patience_(patience) {
  const sigset_t watched = Watched();
  pthread_sigmask(SIG_BLOCK, &watched, nullptr);
  signal_ = 0;
  ::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an error of the write that met it
  thread_ = std::thread([this] { Wait(); });
}

Interrupt::~Interrupt() {
  ending_ = true;
  pthread_kill(thread_.native_handle(), SIGUSR1);
  thread_.join();
}

int Interrupt::NextSignal() const {
  const sigset_t watched = Watched();
  if (!deadline_.has_value()) {
    int number = 0;
    sigwait(&watched, &number);
    return number;
  }
  const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::max(*deadline_ - Clock::now(), Clock::duration::zero()));
  const timespec wait{static_cast<time_t>(left.count() / 1'000'000'000),
                      static_cast<long>(left.count() % 1'000'000'000)};
  const int number = sigtimedwait(&watched, nullptr, &wait);
  if (number > 0) return number;
  return Clock::now() < *deadline_ ? SIGUSR1 : 0;  // something else woke it
}

void Interrupt::Take(int number) {
  signal_ = number;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++count_;
  deadline_.reset();
  if (handler_ == nullptr || count_ > 2) stop_.Request();
  if (handler_ != nullptr) return handler_(number, count_);
  if (count_ > 1) CutOff(number);
  deadline_ = Clock::now() + patience_;
}

void Interrupt::Wait() {
  while (true) {
    const int number = NextSignal();
    if (ending_) return;
    if (number == SIGUSR1) continue;
    if (number == 0) CutOff(signal_);
    Take(number);
  }
}

void Interrupt::SetHandler(Handler handler) {
  const std::lock_guard<std::mutex> lock(mutex_);
  handler_ = std::move(handler);
  count_ = 0;
}

}  // namespace cleave

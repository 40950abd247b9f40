#include "client/cli/interrupt.h"

#include <pthread.h>
#include <signal.h>

#include <utility>

namespace cleave {
namespace {

sigset_t Watched() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&set, number);
  return set;
}

}  // namespace

Interrupt::Interrupt() {
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

void Interrupt::Wait() {
  const sigset_t watched = Watched();
  while (true) {
    int number = 0;
    if (sigwait(&watched, &number) != 0) continue;
    if (ending_) return;
    if (number == SIGUSR1) continue;
    signal_ = number;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++count_;
    if (handler_ == nullptr || count_ > 2) stop_.Request();
    if (handler_ != nullptr) handler_(number, count_);
  }
}

void Interrupt::SetHandler(Handler handler) {
  const std::lock_guard<std::mutex> lock(mutex_);
  handler_ = std::move(handler);
  count_ = 0;
}

}  // namespace cleave

#include "server/gateway/worker_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "server/control/message_socket.h"

namespace cleave {
namespace {

// The number that the worker finds its end of the socket under.
constexpr int kWorkerFd = 3;
// A worker whose socket has ended is on its way out; saving a large state takes a while.
constexpr int kExitGraceMilliseconds = 60'000;

absl::StatusOr<pid_t> Spawn(const WorkerProcess::Options& options, const FileDescriptor& socket) {
  std::vector<std::string> words = {options.program, options.directory, "--control-fd",
                                    absl::StrCat(kWorkerFd)};
  if (options.threads > 0) {
    words.push_back("--threads");
    words.push_back(absl::StrCat(options.threads));
  }
  if (options.encoding.has_value()) {
    words.push_back("--encoding");
    words.push_back(absl::BytesToHexString(options.encoding->SerializeAsString()));
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, socket.get(), kWorkerFd);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process group of its own: Ctrl-C in a terminal is for the gateway, which asks its workers.
  sigset_t no_signals;
  sigemptyset(&no_signals);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setsigmask(&attributes, &no_signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  pid_t pid = 0;
  const int error =
      posix_spawn(&pid, options.program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    return absl::ErrnoToStatus(error, absl::StrCat("cannot start ", options.program));
  }
  return pid;
}

}  // namespace

absl::StatusOr<std::shared_ptr<WorkerProcess>> WorkerProcess::Start(const Options& options,
                                                                    Listener listener) {
  CLEAVE_ASSIGN_OR_RETURN(auto ends, MakeSocketPair());
  CLEAVE_ASSIGN_OR_RETURN(const pid_t pid, Spawn(options, ends.second));
  ends.second.Close();
  std::shared_ptr<WorkerProcess> process(
      new WorkerProcess(pid, std::move(ends.first), std::move(listener)));
  std::thread([process] { process->Read(); }).detach();
  return process;
}

void WorkerProcess::Send(worker::v1::Command command, Done done) {
  absl::Status status;
  {
    const std::lock_guard lock(mutex_);
    command.set_sequence(++last_sequence_);
    status =
        ended_ ? absl::UnavailableError("the worker has ended") : SendMessage(socket_, command);
    if (status.ok()) unacknowledged_.emplace(command.sequence(), std::move(done));
  }
  if (!status.ok()) done(status);
}

void WorkerProcess::Quit() {
  worker::v1::Command command;
  command.mutable_quit();
  Send(command, [](const absl::Status&) {});
  // The end of the socket says the same, also to a worker that reads nothing yet.
  shutdown(socket_.get(), SHUT_WR);
}

void WorkerProcess::Kill() {
  const std::lock_guard lock(mutex_);
  if (!ended_) kill(pid_, SIGKILL);
}

void WorkerProcess::Read() {
  worker::v1::Event event;
  while (ReceiveMessage(socket_, event).ok()) {
    if (event.has_status()) listener_.on_status(event.status());
    if (!event.has_acknowledged()) continue;
    const worker::v1::Acknowledged& answer = event.acknowledged();
    Done done;
    {
      const std::lock_guard lock(mutex_);
      const auto waiting = unacknowledged_.find(answer.sequence());
      if (waiting == unacknowledged_.end()) continue;
      done = std::move(waiting->second);
      unacknowledged_.erase(waiting);
    }
    done(absl::Status(static_cast<absl::StatusCode>(answer.code()), answer.message()));
  }
  const std::string how = Reap();
  std::map<uint64_t, Done> unacknowledged;
  {
    const std::lock_guard lock(mutex_);
    unacknowledged.swap(unacknowledged_);
  }
  for (auto& [sequence, done] : unacknowledged) {
    done(absl::UnavailableError(absl::StrCat("the worker ended (", how, ") before it answered")));
  }
  listener_.on_exit(how);
}

std::string WorkerProcess::Reap() {
  // Waits on the process without a signal handler and without asking again and again.
  const FileDescriptor process(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
  pollfd exited = {process.get(), POLLIN, 0};
  int ready = 0;
  do {
    ready = process.valid() ? poll(&exited, 1, kExitGraceMilliseconds) : 0;
  } while (ready < 0 && errno == EINTR);
  if (ready <= 0) Kill();
  siginfo_t info;
  while (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  // Under the lock, so that nobody signals a pid that is free again.
  const std::lock_guard lock(mutex_);
  int status = 0;
  waitpid(pid_, &status, 0);
  ended_ = true;
  if (WIFSIGNALED(status)) return absl::StrCat("signal ", WTERMSIG(status));
  return absl::StrCat("exit code ", WEXITSTATUS(status));
}

}  // namespace cleave

#include "client/cli/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

std::string Reason() { return std::strerror(errno); }

// Runs in the child between fork and exec: only calls that are safe there.
[[noreturn]] void Become(char* const* words, int input, int output, int errors, int lifeline,
                         pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_DFL);
  setpgid(0, 0);
  fcntl(lifeline, F_SETFD, 0);  // open for as long as the program runs
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // the parent was gone before the line above
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  execv(words[0], words);
  _exit(127);
}

std::string ContentOf(std::FILE* file) {
  std::string content;
  std::rewind(file);
  char part[4096];
  for (size_t size = 0; (size = std::fread(part, 1, sizeof(part), file)) > 0;)
    content.append(part, size);
  return content;
}

}  // namespace

absl::StatusOr<std::unique_ptr<ChildProgram>> ChildProgram::Start(
    const std::vector<std::string>& words, absl::string_view input) {
  std::unique_ptr<ChildProgram> child(new ChildProgram);
  child->name_ = std::filesystem::path(words[0]).filename().string();
  child->output_.reset(std::tmpfile());
  child->errors_.reset(std::tmpfile());
  const File given(std::tmpfile());
  if (child->output_ == nullptr || child->errors_ == nullptr || given == nullptr)
    return absl::InternalError(absl::StrCat("a temporary file for ", child->name_, ": ", Reason()));
  // Children that run beside this one have no use for its files.
  for (std::FILE* file : {child->output_.get(), child->errors_.get(), given.get()})
    fcntl(fileno(file), F_SETFD, FD_CLOEXEC);
  if (std::fwrite(input.data(), 1, input.size(), given.get()) != input.size() ||
      std::fflush(given.get()) != 0)
    return absl::InternalError(absl::StrCat("input for ", child->name_, ": ", Reason()));
  std::rewind(given.get());
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // Whoever started this program may have it ignore children, and waiting would find none.
  signal(SIGCHLD, SIG_DFL);
  std::array<int, 2> lifeline;
  if (pipe2(lifeline.data(), O_CLOEXEC) != 0)
    return absl::InternalError(absl::StrCat("a pipe for ", child->name_, ": ", Reason()));
  child->lifeline_ = lifeline[0];
  const pid_t parent = getpid();
  child->pid_ = fork();
  if (child->pid_ == 0) {
    Become(arguments.data(), fileno(given.get()), fileno(child->output_.get()),
           fileno(child->errors_.get()), lifeline[1], parent);
  }
  close(lifeline[1]);
  if (child->pid_ < 0)
    return absl::InternalError(absl::StrCat("starting ", child->name_, ": ", Reason()));
  return child;
}

ChildProgram::~ChildProgram() {
  Stop();
  if (lifeline_ >= 0) close(lifeline_);
}

void ChildProgram::AwaitAny(const std::vector<const ChildProgram*>& children, int milliseconds) {
  std::vector<pollfd> waits;
  for (const ChildProgram* child : children) waits.push_back({child->lifeline_, POLLIN, 0});
  poll(waits.data(), waits.size(), milliseconds);  // whatever ends it, the caller looks again
}

bool ChildProgram::Ended() {
  if (pid_ >= 0 && waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ < 0;
}

void ChildProgram::Stop() {
  if (Ended()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, &wait_status_, 0);
  pid_ = -1;
}

absl::StatusOr<std::string> ChildProgram::Output() {
  if (pid_ >= 0) {
    const pid_t ended = waitpid(pid_, &wait_status_, 0);
    pid_ = -1;
    if (ended < 0) return absl::InternalError(absl::StrCat("waiting for ", name_, ": ", Reason()));
  }
  if (WIFEXITED(wait_status_) && WEXITSTATUS(wait_status_) == 0) return ContentOf(output_.get());
  const std::string errors(absl::StripAsciiWhitespace(ContentOf(errors_.get())));
  if (!errors.empty()) return absl::InternalError(errors);
  if (WIFSIGNALED(wait_status_)) {
    return absl::InternalError(
        absl::StrCat(name_, " was ended by signal ", WTERMSIG(wait_status_)));
  }
  return absl::InternalError(
      absl::StrCat(name_, " ended with exit code ", WEXITSTATUS(wait_status_)));
}

}  // namespace cleave

#include "client/cpp/embedded_server.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cpp/address.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr char kSocketName[] = "socket";

std::string Reason() { return std::strerror(errno); }

// A folder that only we can enter, in the shortest place that has room for a socket's path.
absl::StatusOr<std::string> MakeSocketDir() {
  std::vector<std::string> places;
  for (const char* name : {"XDG_RUNTIME_DIR", "TMPDIR"})
    if (const char* place = std::getenv(name); place != nullptr && *place == '/')
      places.push_back(place);
  places.push_back("/tmp");
  for (const std::string& place : places) {
    std::string dir = absl::StrCat(place, "/cleave-XXXXXX");
    if (dir.size() + 1 + sizeof(kSocketName) > kMaxSocketPathBytes) continue;
    if (mkdtemp(dir.data()) != nullptr) return dir;
  }
  return absl::InternalError(absl::StrCat("no folder for the embedded server's socket in ",
                                          absl::StrJoin(places, ", "), ": ", Reason()));
}

// The last lines of the log, each indented.
std::string LogTail(const std::string& path) {
  constexpr std::streamoff kTailBytes = 2000;
  std::ifstream in(path, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  if (size <= 0) return "";
  in.seekg(std::max<std::streamoff>(0, size - kTailBytes));
  std::string text(static_cast<size_t>(std::min(size, kTailBytes)), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::vector<std::string> lines = absl::StrSplit(text, '\n', absl::SkipEmpty());
  if (lines.size() > 5) lines.erase(lines.begin(), lines.end() - 5);
  return absl::StrCat("\n  ", absl::StrJoin(lines, "\n  "));
}

// Runs in the child between fork and exec: only calls that are safe there.
[[noreturn]] void BecomeServer(char* const* arguments, int log, pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_DFL);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(0);  // the parent was gone before the line above
  const int null = open("/dev/null", O_RDONLY);
  dup2(null, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(arguments[0], arguments);
  _exit(127);
}

}  // namespace

absl::StatusOr<std::string> FindServerProgram() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::vector<std::filesystem::path> places;
  if (!error) {
    const std::filesystem::path folder = self.parent_path();
    places = {folder / "cleaved", folder / "../server/gateway/cleaved",
              folder / "../../server/gateway/cleaved", folder / "../libexec/cleave/cleaved"};
  }
  if (const char* path = std::getenv("PATH"); path != nullptr)
    for (const absl::string_view folder : absl::StrSplit(path, ':', absl::SkipEmpty()))
      places.push_back(std::filesystem::path(std::string(folder)) / "cleaved");
  for (const std::filesystem::path& place : places)
    if (access(place.c_str(), X_OK) == 0 && !std::filesystem::is_directory(place, error))
      return place.lexically_normal().string();
  return absl::NotFoundError(
      absl::StrCat("the server program cleaved is neither beside ", self.string(),
                   " nor on PATH; install it, or name a running server with --server"));
}

absl::StatusOr<std::unique_ptr<EmbeddedServer>> EmbeddedServer::Start(
    const EmbeddedServerOptions& options) {
  std::string program = options.program;
  if (program.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(program, FindServerProgram());
  }
  std::error_code error;
  std::filesystem::create_directories(options.data_dir, error);
  if (error) return absl::InternalError(absl::StrCat(options.data_dir, ": ", error.message()));
  std::unique_ptr<EmbeddedServer> server(new EmbeddedServer);
  CLEAVE_ASSIGN_OR_RETURN(server->socket_dir_, MakeSocketDir());
  server->log_path_ = absl::StrCat(options.data_dir, "/cleaved.log");
  const int log = open(server->log_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (log < 0) return absl::InternalError(absl::StrCat(server->log_path_, ": ", Reason()));
  std::vector<std::string> words = {program, absl::StrCat("--listen=", server->address()),
                                    absl::StrCat("--data=", options.data_dir)};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  server->pid_ = fork();
  if (server->pid_ == 0) BecomeServer(arguments.data(), log, parent);
  const std::string reason = Reason();
  close(log);
  if (server->pid_ < 0) return absl::InternalError(absl::StrCat("starting cleaved: ", reason));
  return server;
}

std::string EmbeddedServer::address() const {
  return absl::StrCat("unix:", socket_dir_, "/", kSocketName);
}

absl::Status EmbeddedServer::Ended(int wait_status) const {
  const std::string how = WIFSIGNALED(wait_status)
                              ? absl::StrCat("was ended by signal ", WTERMSIG(wait_status))
                              : absl::StrCat("ended with exit code ", WEXITSTATUS(wait_status));
  return absl::UnavailableError(
      absl::StrCat("the embedded server ", how, "; see ", log_path_, LogTail(log_path_)));
}

absl::Status EmbeddedServer::Check() {
  if (pid_ < 0) return absl::UnavailableError("the embedded server is stopped");
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return absl::OkStatus();
  pid_ = -1;
  return Ended(status);
}

absl::Status EmbeddedServer::Stop(double patience_seconds) {
  if (pid_ < 0) return absl::OkStatus();
  kill(pid_, SIGTERM);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_seconds);
  int status = 0;
  pid_t waited = 0;
  while ((waited = waitpid(pid_, &status, WNOHANG)) == 0 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool late = waited == 0;
  if (late) {
    kill(pid_, SIGKILL);
    waitpid(pid_, &status, 0);
  }
  pid_ = -1;
  if (late)
    return absl::DeadlineExceededError(
        absl::StrCat("the embedded server did not end within ", patience_seconds,
                     " s and was killed; its committed frames are safe"));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return absl::OkStatus();
  return Ended(status);
}

EmbeddedServer::~EmbeddedServer() {
  constexpr double kPatienceSeconds = 20;
  Stop(kPatienceSeconds).IgnoreError();  // whoever wants to know calls Stop itself
  std::error_code error;
  if (!socket_dir_.empty()) std::filesystem::remove_all(socket_dir_, error);
}

}  // namespace cleave

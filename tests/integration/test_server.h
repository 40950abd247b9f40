#ifndef CLEAVE_TESTS_INTEGRATION_TEST_SERVER_H_
#define CLEAVE_TESTS_INTEGRATION_TEST_SERVER_H_

#include <sys/types.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cleave/v1/scene.pb.h"
#include "client/cpp/client.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {

// The real cleaved of this build, on a unix socket in a directory of its own, which it can be
// stopped and started in again.
class TestServer {
 public:
  TestServer() { Start(); }
  ~TestServer();

  void Start();
  // SIGKILL: nothing is saved, nobody is told.
  void Kill();
  // SIGTERM; returns the exit code, or -1 when a signal ended it.
  int Stop();

  std::string address() const { return "unix:" + (directory_ / "socket"); }
  std::string data() const { return directory_ / "data"; }
  std::string session_directory(const std::string& id) const { return data() + "/sessions/" + id; }
  pid_t pid() const { return pid_; }
  std::string log() const { return ReadBytes(directory_ / "log"); }
  // Waits for the server to answer. Null, and a failed test, when it does not.
  std::unique_ptr<Client> Connect() const;

 private:
  TemporaryDirectory directory_;
  pid_t pid_ = -1;
};

// A bar of some hundred tets that is pulled until it breaks.
v1::Scene BreakingBar(int64_t frame_count);
// A scene whose first frame takes hours.
v1::Scene EndlessFrame();

// Creates a session; a failed test when it does not work.
v1::Session Create(Client& client, const std::string& id, const v1::Scene& scene);
// Runs to the scene's end and returns every frame's bytes.
std::vector<std::string> RunToEnd(Client& client, const std::string& id);
// Every frame that the server has, without waiting for more.
std::vector<std::string> AllFrames(Client& client, const std::string& id);
// Waits, by WatchSession, for a state that `wanted` accepts.
v1::Session WaitFor(Client& client, const std::string& id,
                    const std::function<bool(const v1::Session&)>& wanted);
bool Rests(const v1::Session& session);

}  // namespace cleave

#endif  // CLEAVE_TESTS_INTEGRATION_TEST_SERVER_H_

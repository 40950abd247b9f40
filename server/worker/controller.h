#ifndef CLEAVE_SERVER_WORKER_CONTROLLER_H_
#define CLEAVE_SERVER_WORKER_CONTROLLER_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "absl/status/status.h"
#include "cleave/v1/session.pb.h"
#include "cleave/worker/v1/control.pb.h"
#include "core/base/stop_flag.h"
#include "server/files/durable_file.h"
#include "server/session/journal.h"

namespace cleave {

// What the run loop is told to do next.
enum class Order {
  kAdvance,  // work towards the goal in force
  kRest,     // nothing is asked
  kQuit,
};

// Stands between the gateway and the run loop: its own thread takes commands, journals them,
// acknowledges them and raises the stop flag, also while the run loop is deep in a solve. Every
// event leaves in the order of the changes that it tells of.
//
// The run loop calls the public functions from one thread. SIGTERM, SIGINT and the end of the
// control socket are quit commands; both signals must be blocked in the whole process beforehand.
class Controller {
 public:
  // `control` may be invalid: then there is nobody to listen to but signals.
  explicit Controller(FileDescriptor control) : control_(std::move(control)) {}
  ~Controller();

  // Starts to listen. `journal` and `state` are those of the session directory.
  absl::Status Start(JournalWriter journal, JournalState state);

  // Raised by commands that interrupt a computation; cleared by Take.
  const StopFlag& stop() const { return stop_; }
  // Clears a stop that was not meant for the caller (a pause, while the past is replayed). False
  // once the session shall be left as it is.
  bool KeepGoing();

  // Tells the gateway about a state on the way to the run loop (PREPARING, RECOVERING).
  void Report(v1::SessionState state, int64_t head);

  // Puts a goal in force as if it had been commanded, unless there is one.
  absl::Status RunTo(int64_t until_frame);

  // The next order. Ends a goal that `head` has reached, in the journal, and reports.
  absl::StatusOr<Order> Take(int64_t head);
  // Waits until Take may answer something other than kRest.
  void Wait();

  // A frame is committed.
  void Committed(int64_t head, const v1::Progress& progress, bool broke_edges);
  // The simulation cannot go on from its head; later runs may try again. Journals, unless the disk
  // is what failed, and reports.
  void Failed(const v1::Error& error);
  // OK, or why the session stands.
  absl::Status failure() const;

 private:
  void Listen();
  void HandleCommand(const worker::v1::Command& command);
  absl::Status Obey(const worker::v1::Command& command);
  absl::Status Journal(const worker::v1::JournalRecord& record);
  bool GoalReached(int64_t head) const;
  void SendStatus();
  void Send(const worker::v1::Event& event);
  void Quit();

  FileDescriptor control_;
  FileDescriptor signals_;
  FileDescriptor wake_;  // ends Listen
  StopFlag stop_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<JournalWriter> journal_;
  JournalState state_;
  std::chrono::steady_clock::time_point goal_start_;
  bool goal_broke_edges_ = false;
  bool attention_ = false;  // something happened since the last Take
  bool quit_ = false;
  worker::v1::Status status_;

  std::thread listener_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_CONTROLLER_H_

#ifndef CLEAVE_SERVER_GATEWAY_SESSION_STORE_H_
#define CLEAVE_SERVER_GATEWAY_SESSION_STORE_H_

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/v1/session.pb.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/hosted_session.h"

namespace cleave {

// All sessions of a data directory. Functions wait for the disk unless they say otherwise.
// Thread-safe.
class SessionStore {
 public:
  // Takes up the sessions below `data`/sessions; those with an unfinished goal go on at once. What
  // a crash left half created or half deleted is removed. `assets` must outlive the store.
  static absl::StatusOr<std::unique_ptr<SessionStore>> Open(const std::string& data,
                                                            AssetStore& assets,
                                                            const WorkerOptions& workers);

  // Checks everything, lays out the directory and starts the worker. A request_id that was seen
  // before, and an id that exists with the same scene, answer with the session that is there.
  // Errors: those of AcceptScene; InvalidArgument; AlreadyExists.
  absl::StatusOr<v1::CreateSessionResponse> Create(const v1::CreateSessionRequest& request);

  // Does not wait. Errors: InvalidArgument for a malformed name, NotFound.
  absl::StatusOr<std::shared_ptr<HostedSession>> Find(const std::string& name) const;

  // Sessions after `after` by id, at most `limit`, and whether there are more. Does not wait.
  std::vector<std::shared_ptr<HostedSession>> List(const std::string& after, size_t limit,
                                                   bool& more) const;

  // Removes a session; `done` comes when its name is free. NotFound as from Find.
  void Delete(const std::string& name, std::function<void(absl::Status)> done);

  // Does not wait: lets every worker save and exit, and begins nothing new.
  void Shutdown();
  // Waits until every worker has ended; false, and ends them by force, when some are after
  // `timeout`.
  bool WaitForWorkers(std::chrono::milliseconds timeout);

 private:
  SessionStore(const std::string& data, AssetStore& assets, const WorkerOptions& workers)
      : directory_(data + "/sessions"), assets_(assets), workers_(workers) {}

  absl::Status Scan();
  absl::StatusOr<v1::CreateSessionResponse> CreateReserved(const v1::CreateSessionRequest& request,
                                                           const std::string& scene_sha256);
  // The answer for a session that exists already. Needs mutex_.
  absl::StatusOr<std::shared_ptr<HostedSession>> FindEarlier(
      const v1::CreateSessionRequest& request, const std::string& scene_sha256) const;
  void AddLocked(const std::shared_ptr<HostedSession>& session);

  const std::string directory_;
  AssetStore& assets_;
  const WorkerOptions workers_;

  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<HostedSession>> sessions_;  // by id
  std::map<std::string, std::string> requests_;                     // request_id -> id
  std::set<std::string> being_created_;                             // ids
  bool shutting_down_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_SESSION_STORE_H_

#include "server/gateway/session_store.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
#include "server/files/durable_file.h"
#include "server/gateway/errors.h"
#include "server/gateway/log.h"
#include "server/gateway/random_id.h"
#include "server/gateway/scene_intake.h"
#include "server/session/config.h"

namespace cleave {
namespace {

// What names of directories that are not whole sessions begin with; ids begin with a letter.
constexpr absl::string_view kScratchPrefix = ".";
constexpr size_t kMaxRequestIdBytes = 128;
constexpr int kMaxThreads = 1024;

constexpr absl::string_view kSessionIdRule =
    "a letter and 2 to 62 letters, digits or dashes, all lower-case";

bool IsSessionId(absl::string_view id) {
  return id.size() >= 3 && id.size() <= 63 && id[0] >= 'a' && id[0] <= 'z' &&
         std::all_of(id.begin(), id.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
         });
}

Faults CheckRequest(const v1::CreateSessionRequest& request) {
  Faults faults;
  if (!IsSessionId(request.session_id()) &&
      !(request.validate_only() && request.session_id().empty())) {
    faults.Error("session_id", absl::StrCat("\"", absl::CEscape(request.session_id().substr(0, 80)),
                                            "\" is not ", kSessionIdRule));
  }
  if (request.request_id().size() > kMaxRequestIdBytes) {
    faults.Error("request_id", absl::StrCat("has more than ", kMaxRequestIdBytes, " bytes"));
  }
  if (request.threads() < 0 || request.threads() > kMaxThreads) {
    faults.Error("threads", absl::StrCat(request.threads(), " is outside [0, ", kMaxThreads, "]"));
  }
  if (!v1::Rung_IsValid(request.rung())) {
    faults.Error("rung", absl::StrCat(static_cast<int>(request.rung()), " is no rung"));
  } else if (request.rung() != v1::RUNG_UNSPECIFIED && request.scene().output().has_tolerance()) {
    faults.Error("rung", "scene.output.tolerance says what the session keeps; leave one out");
  }
  return faults;
}

// The same for equal messages of one build.
std::string DigestOf(const v1::Scene& scene) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    scene.SerializeToCodedStream(&coded);
  }
  return Sha256::Of(bytes);
}

absl::Status NotFound(const std::string& name) {
  return MakeError(absl::StatusCode::kNotFound, "SESSION_NOT_FOUND",
                   absl::StrCat("there is no session ", name), {{"session", name}});
}

// Where something is out of sight before it is removed, or before it is whole.
std::string ScratchPath(const std::string& directory) {
  return absl::StrCat(directory, "/", kScratchPrefix, NewUid());
}

void RemoveTree(const std::string& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) {
    Log(LogLevel::kWarning, "cannot_remove", {{"path", path}, {"reason", error.message()}});
  }
}

}  // namespace

absl::StatusOr<std::unique_ptr<SessionStore>> SessionStore::Open(const std::string& data,
                                                                 AssetStore& assets,
                                                                 const WorkerOptions& workers) {
  std::unique_ptr<SessionStore> store(new SessionStore(data, assets, workers));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(store->directory_));
  CLEAVE_RETURN_IF_ERROR(store->Scan());
  return store;
}

absl::Status SessionStore::Scan() {
  std::error_code error;
  std::filesystem::directory_iterator entry(directory_, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const SessionPaths paths{entry->path().string()};
    const std::string id = entry->path().filename().string();
    if (absl::StartsWith(id, kScratchPrefix)) {
      RemoveTree(paths.root);
      continue;
    }
    absl::StatusOr<worker::v1::SessionConfig> config = ReadSessionConfig(paths);
    if (config.ok() && config->session_id() != id) {
      config = absl::DataLossError("the directory has another session's config");
    }
    absl::Status status = config.status();
    if (status.ok()) {
      const auto session = std::make_shared<HostedSession>(paths, *std::move(config), workers_);
      status = session->Load();
      const std::lock_guard lock(mutex_);
      if (status.ok()) AddLocked(session);
    }
    // One damaged session must not keep the others down.
    if (!status.ok()) {
      Log(LogLevel::kError, "session_unreadable",
          {{"session", id}, {"reason", std::string(status.message())}});
    }
  }
  if (error) return absl::ErrnoToStatus(error.value(), absl::StrCat("cannot list ", directory_));
  return absl::OkStatus();
}

void SessionStore::AddLocked(const std::shared_ptr<HostedSession>& session) {
  const worker::v1::SessionConfig& config = session->config();
  sessions_[config.session_id()] = session;
  if (!config.request_id().empty()) requests_[config.request_id()] = config.session_id();
}

absl::StatusOr<std::shared_ptr<HostedSession>> SessionStore::FindEarlier(
    const v1::CreateSessionRequest& request, const std::string& scene_sha256) const {
  const auto seen = requests_.find(request.request_id());
  if (seen != requests_.end()) return sessions_.at(seen->second);
  const auto existing = sessions_.find(request.session_id());
  if (existing == sessions_.end()) return nullptr;
  const worker::v1::SessionConfig& config = existing->second->config();
  const bool same_scene = config.scene_sha256() == scene_sha256;
  if (same_scene && config.rung() == request.rung()) return existing->second;
  return MakeError(absl::StatusCode::kAlreadyExists, "SESSION_EXISTS",
                   absl::StrCat(existing->second->name(), " exists with another ",
                                same_scene ? "rung" : "scene"),
                   {{"session", existing->second->name()}});
}

absl::StatusOr<v1::CreateSessionResponse> SessionStore::Create(
    const v1::CreateSessionRequest& request) {
  const Faults request_faults = CheckRequest(request);
  if (request.validate_only() || !request_faults.ok()) {
    CLEAVE_ASSIGN_OR_RETURN(const AcceptedScene accepted,
                            AcceptScene(request.scene(), request_faults, assets_,
                                        /*store_mesh=*/false));
    v1::CreateSessionResponse response;
    *response.mutable_plan() = accepted.plan;
    response.mutable_warnings()->Assign(accepted.warnings.begin(), accepted.warnings.end());
    return response;
  }
  const std::string scene_sha256 = DigestOf(request.scene());
  {
    const std::lock_guard lock(mutex_);
    if (shutting_down_) return MakeRetryLater("DRAINING", "the server goes down", 2);
    CLEAVE_ASSIGN_OR_RETURN(const std::shared_ptr<HostedSession> earlier,
                            FindEarlier(request, scene_sha256));
    if (earlier != nullptr) {
      v1::CreateSessionResponse response;
      *response.mutable_session() = earlier->View(/*with_scene=*/true);
      return response;
    }
    if (!being_created_.insert(request.session_id()).second) {
      return MakeRetryLater("SESSION_BEING_CREATED", "another call creates this session", 1);
    }
  }
  absl::Cleanup give_back = [&] {
    const std::lock_guard lock(mutex_);
    being_created_.erase(request.session_id());
  };
  return CreateReserved(request, scene_sha256);
}

absl::StatusOr<v1::CreateSessionResponse> SessionStore::CreateReserved(
    const v1::CreateSessionRequest& request, const std::string& scene_sha256) {
  CLEAVE_ASSIGN_OR_RETURN(AcceptedScene accepted,
                          AcceptScene(request.scene(), {}, assets_, /*store_mesh=*/true));
  worker::v1::SessionConfig config;
  config.set_session_id(request.session_id());
  config.set_uid(NewUid());
  const int64_t now = absl::ToUnixNanos(absl::Now());
  config.mutable_create_time()->set_seconds(now / 1'000'000'000);
  config.mutable_create_time()->set_nanos(static_cast<int32_t>(now % 1'000'000'000));
  *config.mutable_scene() = std::move(accepted.scene);
  config.set_threads(request.threads());
  config.set_request_id(request.request_id());
  config.set_scene_sha256(scene_sha256);
  config.set_rung(request.rung());

  const std::string scratch = ScratchPath(directory_);
  const std::string root = absl::StrCat(directory_, "/", request.session_id());
  absl::Status status = CreateSessionDirectory({scratch}, config);
  if (status.ok()) status = RenameDurably(scratch, root);
  if (!status.ok()) {
    RemoveTree(scratch);
    return status;
  }
  const auto session = std::make_shared<HostedSession>(SessionPaths{root}, config, workers_);
  CLEAVE_RETURN_IF_ERROR(session->Load());
  {
    const std::lock_guard lock(mutex_);
    AddLocked(session);
  }
  // The session exists; a worker that cannot start now is started by the first run.
  if (const absl::Status started = session->StartWorker(); !started.ok()) {
    Log(LogLevel::kError, "worker_not_started",
        {{"session", request.session_id()}, {"reason", std::string(started.message())}});
  }
  Log(LogLevel::kInfo, "session_created",
      {{"session", request.session_id()}, {"tets", absl::StrCat(accepted.plan.tet_count())}});
  v1::CreateSessionResponse response;
  *response.mutable_session() = session->View(/*with_scene=*/true);
  *response.mutable_plan() = std::move(accepted.plan);
  response.mutable_warnings()->Assign(accepted.warnings.begin(), accepted.warnings.end());
  return response;
}

absl::StatusOr<std::shared_ptr<HostedSession>> SessionStore::Find(const std::string& name) const {
  absl::string_view id = name;
  if (!absl::ConsumePrefix(&id, "sessions/") || !IsSessionId(id)) {
    return MakeBadField("name", absl::StrCat("\"", absl::CEscape(name.substr(0, 80)),
                                             "\" is not \"sessions/\" and ", kSessionIdRule));
  }
  const std::lock_guard lock(mutex_);
  const auto session = sessions_.find(std::string(id));
  if (session == sessions_.end()) return NotFound(name);
  return session->second;
}

std::vector<std::shared_ptr<HostedSession>> SessionStore::List(const std::string& after,
                                                               size_t limit, bool& more) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<HostedSession>> page;
  auto session = sessions_.upper_bound(after);
  for (; session != sessions_.end() && page.size() < limit; ++session) {
    page.push_back(session->second);
  }
  more = session != sessions_.end();
  return page;
}

void SessionStore::Delete(const std::string& name, std::function<void(absl::Status)> done) {
  const absl::StatusOr<std::shared_ptr<HostedSession>> found = Find(name);
  if (!found.ok()) return done(found.status());
  const std::shared_ptr<HostedSession> session = *found;
  const std::string id = session->config().session_id();
  {
    // Out of the directory of sessions at once: of two deletions one finds nothing. The id stays
    // reserved until its directory is gone.
    const std::lock_guard lock(mutex_);
    if (sessions_.erase(id) == 0) return done(NotFound(name));
    requests_.erase(session->config().request_id());
    being_created_.insert(id);
  }
  session->Delete([this, session, id, done = std::move(done)] {
    const std::string scratch = ScratchPath(directory_);
    const absl::Status status = RenameDurably(session->paths().root, scratch);
    {
      const std::lock_guard lock(mutex_);
      being_created_.erase(id);
    }
    Log(LogLevel::kInfo, "session_deleted", {{"session", id}});
    done(status);
    RemoveTree(scratch);
  });
}

void SessionStore::Shutdown() {
  std::vector<std::shared_ptr<HostedSession>> sessions;
  {
    const std::lock_guard lock(mutex_);
    shutting_down_ = true;
    for (const auto& [id, session] : sessions_) sessions.push_back(session);
  }
  for (const auto& session : sessions) session->Shutdown();
}

bool SessionStore::WaitForWorkers(std::chrono::milliseconds timeout) {
  std::vector<std::shared_ptr<HostedSession>> sessions;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, session] : sessions_) sessions.push_back(session);
  }
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  bool all_ended = true;
  for (const auto& session : sessions) all_ended &= session->WaitForWorkers(deadline);
  return all_ended;
}

}  // namespace cleave

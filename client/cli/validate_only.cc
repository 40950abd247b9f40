#include "client/cli/validate_only.h"

#include <utility>

#include "client/cli/session_start.h"
#include "core/base/status.h"

namespace cleave {

absl::StatusOr<v1::CreateSessionResponse> ValidateOnServer(Client& client, const SceneInput& input,
                                                           bool quiet) {
  v1::CreateSessionRequest request;
  CLEAVE_ASSIGN_OR_RETURN(*request.mutable_scene(), SceneForServer(client, input, quiet));
  request.set_session_id(NewSessionId(input.file.path));
  request.set_validate_only(true);
  auto response = client.CreateSession(std::move(request));
  if (!response.ok()) return WithLines(input.file, response.status());
  return response;
}

}  // namespace cleave

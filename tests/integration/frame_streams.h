#ifndef CLEAVE_TESTS_INTEGRATION_FRAME_STREAMS_H_
#define CLEAVE_TESTS_INTEGRATION_FRAME_STREAMS_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "tests/integration/test_server.h"

// Viewers of a session "bar".
namespace cleave {

inline constexpr int64_t kFrames = 60;

inline FrameStreamOptions Asking(std::optional<Rung> rung) {
  FrameStreamOptions options;
  options.session = "sessions/bar";
  options.rung = rung;
  return options;
}

inline std::vector<std::string> Take(FrameStream& stream, int64_t count) {
  std::vector<std::string> frames;
  while (static_cast<int64_t>(frames.size()) < count) {
    absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (!frame.ok() || !frame->has_value()) break;
    frames.push_back(std::move((*frame)->bytes));
  }
  return frames;
}

inline std::vector<std::string> TakeAll(FrameStream& stream) { return Take(stream, kFrames + 2); }

inline std::vector<std::string> TakeAll(Client& client, Rung rung) {
  FrameStream stream(client, Asking(rung));
  return TakeAll(stream);
}

inline v1::Session CreateLossless(Client& client) {
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = BreakingBar(kFrames);
  request.set_rung(v1::RUNG_LOSSLESS);
  const absl::StatusOr<v1::CreateSessionResponse> created = client.CreateSession(request);
  EXPECT_TRUE(created.ok()) << created.status();
  return created->session();
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_INTEGRATION_FRAME_STREAMS_H_

#include "server/control/message_socket.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <string>

#include "cleave/worker/v1/control.pb.h"

namespace cleave {
namespace {

worker::v1::Command SomeCommand() {
  worker::v1::Command command;
  command.set_sequence(7);
  command.mutable_run()->mutable_goal()->set_until_frame(12);
  return command;
}

TEST(MessageSocketTest, WhatIsSentArrives) {
  auto ends = MakeSocketPair();
  ASSERT_TRUE(ends.ok());
  ASSERT_TRUE(SendMessage(ends->first, SomeCommand()).ok());
  worker::v1::Command received;
  ASSERT_TRUE(ReceiveMessage(ends->second, received).ok());
  EXPECT_EQ(received.run().goal().until_frame(), 12);
}

TEST(MessageSocketTest, AClosedSocketIsOutOfRangeBetweenMessagesAndDataLossWithinOne) {
  auto whole = MakeSocketPair();
  ASSERT_TRUE(SendMessage(whole->first, SomeCommand()).ok());
  char bytes[256];
  const ssize_t size = recv(whole->second.get(), bytes, sizeof(bytes), 0);
  for (ssize_t cut = 0; cut < size; ++cut) {
    auto ends = MakeSocketPair();
    ASSERT_EQ(send(ends->first.get(), bytes, static_cast<size_t>(cut), 0), cut);
    ends->first.Close();
    worker::v1::Command received;
    const absl::Status status = ReceiveMessage(ends->second, received);
    EXPECT_EQ(status.code(),
              cut == 0 ? absl::StatusCode::kOutOfRange : absl::StatusCode::kDataLoss);
  }
}

TEST(MessageSocketTest, AnAbsurdLengthIsRefused) {
  auto ends = MakeSocketPair();
  ASSERT_EQ(send(ends->first.get(), "\xff\xff\xff\xff", 4, 0), 4);
  worker::v1::Command received;
  EXPECT_TRUE(absl::IsDataLoss(ReceiveMessage(ends->second, received)));
}

TEST(MessageSocketTest, SendingToAPeerThatDoesNotReadEndsInsteadOfWaiting) {
  auto ends = MakeSocketPair();
  worker::v1::Event event;
  event.mutable_acknowledged()->set_message(std::string(100'000, 'x'));
  absl::Status status;
  for (int i = 0; i < 1000 && status.ok(); ++i) status = SendMessage(ends->first, event);
  EXPECT_TRUE(absl::IsUnavailable(status));
}

}  // namespace
}  // namespace cleave

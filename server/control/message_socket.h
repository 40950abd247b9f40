#ifndef CLEAVE_SERVER_CONTROL_MESSAGE_SOCKET_H_
#define CLEAVE_SERVER_CONTROL_MESSAGE_SOCKET_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "google/protobuf/message_lite.h"
#include "server/files/durable_file.h"

namespace cleave {

// Two connected stream sockets, closed on exec.
absl::StatusOr<std::pair<FileDescriptor, FileDescriptor>> MakeSocketPair();

// Sends a message behind its length, a little-endian uint32. Never waits: Unavailable when the peer
// is gone or does not read. One sender at a time.
absl::Status SendMessage(const FileDescriptor& socket,
                         const google::protobuf::MessageLite& message);

// Waits for a message. OutOfRange when the peer closed its end between messages, DataLoss when it
// did so within one or sent what is not a message.
absl::Status ReceiveMessage(const FileDescriptor& socket, google::protobuf::MessageLite& message);

}  // namespace cleave

#endif  // CLEAVE_SERVER_CONTROL_MESSAGE_SOCKET_H_

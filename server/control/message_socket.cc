#include "server/control/message_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr uint32_t kMaxMessageBytes = 1 << 20;

// Reads until `size` bytes are there; the count is smaller when the peer closed.
absl::StatusOr<size_t> ReceiveBytes(const FileDescriptor& socket, char* bytes, size_t size) {
  size_t done = 0;
  while (done < size) {
    const ssize_t got = recv(socket.get(), bytes + done, size - done, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == ECONNRESET) break;
    if (got < 0) return absl::ErrnoToStatus(errno, "cannot read the control socket");
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  return done;
}

}  // namespace

absl::StatusOr<std::pair<FileDescriptor, FileDescriptor>> MakeSocketPair() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return absl::ErrnoToStatus(errno, "cannot make a control socket");
  }
  return std::make_pair(FileDescriptor(ends[0]), FileDescriptor(ends[1]));
}

absl::Status SendMessage(const FileDescriptor& socket,
                         const google::protobuf::MessageLite& message) {
  const size_t size = message.ByteSizeLong();
  if (size > kMaxMessageBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("a control message of ", size, " bytes exceeds ", kMaxMessageBytes));
  }
  std::string bytes;
  ByteWriter(bytes).Put<uint32_t>(static_cast<uint32_t>(size));
  message.AppendToString(&bytes);
  absl::string_view left = bytes;
  while (!left.empty()) {
    const ssize_t sent = send(socket.get(), left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      const absl::Status status = absl::ErrnoToStatus(errno, "cannot write the control socket");
      // A message sent in part would turn all later ones into nonsense.
      shutdown(socket.get(), SHUT_RDWR);
      return absl::UnavailableError(status.message());
    }
    left.remove_prefix(static_cast<size_t>(sent));
  }
  return absl::OkStatus();
}

absl::Status ReceiveMessage(const FileDescriptor& socket, google::protobuf::MessageLite& message) {
  uint32_t size = 0;
  CLEAVE_ASSIGN_OR_RETURN(size_t got,
                          ReceiveBytes(socket, reinterpret_cast<char*>(&size), sizeof(size)));
  if (got == 0) return absl::OutOfRangeError("the control socket was closed");
  if (got < sizeof(size)) return absl::DataLossError("the control socket was cut in a message");
  if (size > kMaxMessageBytes) {
    return absl::DataLossError(absl::StrCat("a control message claims ", size, " bytes"));
  }
  std::string bytes(size, '\0');
  CLEAVE_ASSIGN_OR_RETURN(got, ReceiveBytes(socket, bytes.data(), bytes.size()));
  if (got < size) return absl::DataLossError("the control socket was cut in a message");
  if (!message.ParseFromString(bytes)) {
    return absl::DataLossError("a control message does not parse");
  }
  return absl::OkStatus();
}

}  // namespace cleave

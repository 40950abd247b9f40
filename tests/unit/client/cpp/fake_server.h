#ifndef CLEAVE_TESTS_UNIT_CLIENT_CPP_FAKE_SERVER_H_
#define CLEAVE_TESTS_UNIT_CLIENT_CPP_FAKE_SERVER_H_

#include <grpc/grpc.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "cleave/v1/server.grpc.pb.h"
#include "client/cpp/client.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {

class FakeServerService : public v1::ServerService::Service {
  grpc::Status GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*,
                             v1::ServerInfo* info) override {
    info->set_server_version("fake");
    return grpc::Status::OK;
  }
};

// Serves `service` and a ServerService on a unix socket, and connects a client to it.
class FakeServer {
 public:
  explicit FakeServer(grpc::Service& service) {
    // Once more than the library ends: at its end one time in ten it waits ten seconds for a poll.
    grpc_init();
    const std::string address = absl::StrCat("unix:", directory_ / "socket");
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterService(&service);
    builder.RegisterService(&info_);
    server_ = builder.BuildAndStart();
    auto connected = Client::Connect(address, std::chrono::seconds(10), nullptr);
    EXPECT_TRUE(connected.ok()) << connected.status();
    if (connected.ok()) client_ = *std::move(connected);
  }
  ~FakeServer() { server_->Shutdown(std::chrono::system_clock::now()); }

  Client& client() { return *client_; }

 private:
  const TemporaryDirectory directory_;
  FakeServerService info_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<Client> client_;
};

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CLIENT_CPP_FAKE_SERVER_H_

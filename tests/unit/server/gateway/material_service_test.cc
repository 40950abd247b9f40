#include "server/gateway/rpc/material_service.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using namespace std::chrono_literals;

// What the server learns and says of its only call.
struct Call {
  std::promise<void> asked;      // the request is here
  std::promise<void> abandoned;  // nobody waits for the answer
  std::promise<grpc::Status> answered;
};

class CallWatch final : public grpc::experimental::Interceptor,
                        public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit CallWatch(Call& call) : call_(call) {}

  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* /*info*/) override {
    return new CallWatch(call_);
  }
  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    using Point = grpc::experimental::InterceptionHookPoints;
    if (methods->QueryInterceptionHookPoint(Point::POST_RECV_MESSAGE)) call_.asked.set_value();
    if (methods->QueryInterceptionHookPoint(Point::POST_RECV_CLOSE)) call_.abandoned.set_value();
    if (methods->QueryInterceptionHookPoint(Point::PRE_SEND_STATUS))
      call_.answered.set_value(methods->GetSendStatus());
    methods->Proceed();
  }

 private:
  Call& call_;
};

// As long as a probe can be: about a second.
v1::ProbeMaterialRequest LongProbe() {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("dry_wood");
  for (int k = 0; k < 16; ++k) {
    for (const double x : {1, k, 1}) request.add_pull_directions(x);
  }
  request.set_samples(1000);
  return request;
}

TEST(MaterialService, AProbeEndsWhenItsCallIsCancelledOrPastItsDeadline) {
  for (const bool cancelled : {true, false}) {
    const TemporaryDirectory directory;
    Executor executor(1);
    MaterialService service(executor);
    Call call;
    std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> watches;
    watches.push_back(std::make_unique<CallWatch>(call));
    grpc::ServerBuilder builder;
    const std::string address = "unix:" + (directory / "socket");
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterService(&service);
    builder.experimental().SetInterceptorCreators(std::move(watches));
    const std::unique_ptr<grpc::Server> server = builder.BuildAndStart();
    ASSERT_NE(server, nullptr);
    const auto stub = v1::MaterialService::NewStub(
        grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));

    // The probe waits behind this until its call is given up.
    std::promise<void> gate;
    executor.Submit([&gate] { gate.get_future().wait(); });
    grpc::ClientContext context;
    if (!cancelled) context.set_deadline(std::chrono::system_clock::now() + 500ms);
    const v1::ProbeMaterialRequest request = LongProbe();
    v1::ProbeMaterialResponse response;
    std::future<grpc::Status> status = std::async(
        std::launch::async, [&] { return stub->ProbeMaterial(&context, request, &response); });
    call.asked.get_future().wait();
    if (cancelled) context.TryCancel();
    EXPECT_EQ(status.get().error_code(),
              cancelled ? grpc::StatusCode::CANCELLED : grpc::StatusCode::DEADLINE_EXCEEDED);
    call.abandoned.get_future().wait();
    gate.set_value();
    EXPECT_EQ(call.answered.get_future().get().error_code(), grpc::StatusCode::CANCELLED);
    server->Shutdown();
  }
}

}  // namespace
}  // namespace cleave

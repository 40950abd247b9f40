#include "client/cpp/client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "cleave/v1/impurity.grpc.pb.h"
#include "cleave/v1/material.grpc.pb.h"
#include "cleave/v1/session.grpc.pb.h"
#include "tests/unit/client/cpp/fake_server.h"

namespace cleave {
namespace {

// Loses the answer of the first call of each kind, after having done the work.
class ForgetfulSessions : public v1::SessionService::Service {
 public:
  grpc::Status CreateSession(grpc::ServerContext*, const v1::CreateSessionRequest* request,
                             v1::CreateSessionResponse* response) override {
    created_ids.insert(request->request_id());
    response->mutable_session()->set_name(SessionName(request->session_id()));
    return Lose(create_calls);
  }
  grpc::Status DeleteSession(grpc::ServerContext*, const v1::DeleteSessionRequest*,
                             google::protobuf::Empty*) override {
    if (delete_calls > 0) return grpc::Status(grpc::StatusCode::NOT_FOUND, "gone");
    return Lose(delete_calls);
  }
  grpc::Status ListSessions(grpc::ServerContext*, const v1::ListSessionsRequest* request,
                            v1::ListSessionsResponse* response) override {
    response->add_sessions()->set_name(absl::StrCat("sessions/after-", request->page_token()));
    if (request->page_token() != "2")
      response->set_next_page_token(request->page_token().empty() ? "1" : "2");
    return grpc::Status::OK;
  }

  static grpc::Status Lose(int& calls) {
    return ++calls == 1 ? grpc::Status(grpc::StatusCode::UNAVAILABLE, "lost") : grpc::Status::OK;
  }
  int create_calls = 0;
  int delete_calls = 0;
  std::set<std::string> created_ids;
};

TEST(Client, LostAnswerIsAskedForAgainUnderTheSameRequestId) {
  ForgetfulSessions service;
  FakeServer server(service);
  v1::CreateSessionRequest request;
  request.set_session_id("rod");
  const auto response = server.client().CreateSession(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->session().name(), "sessions/rod");
  EXPECT_EQ(service.create_calls, 2);
  EXPECT_EQ(service.created_ids.size(), 1u);
  EXPECT_EQ(service.created_ids.begin()->size(), 32u);
}

TEST(Client, DeletionWhoseAnswerWasLostSucceeded) {
  ForgetfulSessions service;
  FakeServer server(service);
  EXPECT_TRUE(server.client().DeleteSession("sessions/rod", false).ok());
}

TEST(Client, AllPagesAreListed) {
  ForgetfulSessions service;
  FakeServer server(service);
  const auto sessions = server.client().ListSessions();
  ASSERT_TRUE(sessions.ok()) << sessions.status();
  ASSERT_EQ(sessions->size(), 3u);
  EXPECT_EQ((*sessions)[2].name(), "sessions/after-2");
}

class ForgetfulMaterials : public v1::MaterialService::Service {
 public:
  grpc::Status ProbeMaterial(grpc::ServerContext*, const v1::ProbeMaterialRequest* request,
                             v1::ProbeMaterialResponse* response) override {
    response->mutable_material()->set_name(request->material().preset());
    return ForgetfulSessions::Lose(calls);
  }
  int calls = 0;
};

TEST(Client, ProbeWhoseAnswerWasLostIsAskedForAgain) {
  ForgetfulMaterials service;
  FakeServer server(service);
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("glass");
  const auto response = server.client().ProbeMaterial(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->material().name(), "glass");
  EXPECT_EQ(service.calls, 2);
}

// Knows how long calls wait for their answers.
class PatientSessions : public v1::SessionService::Service {
  grpc::Status CreateSession(grpc::ServerContext* context, const v1::CreateSessionRequest*,
                             v1::CreateSessionResponse*) override {
    until = context->deadline();
    return grpc::Status::OK;
  }

 public:
  std::chrono::system_clock::time_point until;
};
class PatientImpurities : public v1::ImpurityService::Service {
  grpc::Status PreviewImpurity(grpc::ServerContext* context, const v1::PreviewImpurityRequest*,
                               v1::PreviewImpurityResponse*) override {
    until = context->deadline();
    return grpc::Status::OK;
  }

 public:
  std::chrono::system_clock::time_point until;
};

TEST(Client, CallsThatMakeOrBakeABodyWaitMinutes) {
  const auto start = std::chrono::system_clock::now();
  PatientSessions sessions;
  EXPECT_TRUE(FakeServer(sessions).client().CreateSession({}).ok());
  EXPECT_GE(sessions.until - start, std::chrono::minutes(4));
  PatientImpurities impurities;
  EXPECT_TRUE(FakeServer(impurities).client().PreviewImpurity({}).ok());
  EXPECT_GE(impurities.until - start, std::chrono::minutes(4));
}

TEST(Client, NobodyAtTheAddressIsUnavailableAndNamesIt) {
  const auto client =
      Client::Connect("unix:/nonexistent/socket", std::chrono::milliseconds(300), nullptr);
  EXPECT_TRUE(absl::IsUnavailable(client.status())) << client.status();
  EXPECT_THAT(std::string(client.status().message()),
              testing::HasSubstr("unix:/nonexistent/socket"));
}

TEST(Client, NamesAndIdsMayBeTypedEitherWay) {
  EXPECT_EQ(SessionName("rod"), "sessions/rod");
  EXPECT_EQ(SessionName("sessions/rod"), "sessions/rod");
  EXPECT_EQ(SessionId("sessions/rod"), "rod");
}

}  // namespace
}  // namespace cleave

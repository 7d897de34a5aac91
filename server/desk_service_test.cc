// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/desk_service.h"

#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::server {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class DeskServiceThread : public ::testing::Test {
 protected:
  void serve(const pipeline::Wanted& wanted = pipeline::rig_at(), std::function<bool()> stop = nullptr,
             std::function<void(const pipeline::DeskState&)> ended = nullptr) {
    auto desk = std::make_unique<pipeline::FakeDesk>();
    desk_ = desk.get();
    auto session = std::make_unique<pipeline::DeskSession>(*desk, wanted);
    service_ = std::make_unique<DeskService>(
        Keys{.hosts = {"127.0.0.1:1"}, .token = "t", .session = "s"},
        "<meta content=\"default-src 'none'; x\"><style>a</style><script type=\"module\">b</script>", "0123",
        ServedDesk{std::move(desk), std::move(session), std::move(stop), std::move(ended)});
  }
  Response ask(const Request& request) {
    std::promise<Response> answer;
    service_->handle(request, [&answer](Response response) { answer.set_value(std::move(response)); });
    return answer.get_future().get();
  }
  Response get(const std::string& target) {
    return ask({.method = "GET", .target = "/s" + target, .host = "127.0.0.1:1"});
  }
  static Request posting(const std::string& body) {
    return {.method = "POST",
            .target = "/s/api/desk",
            .host = "127.0.0.1:1",
            .origin = "http://127.0.0.1:1",
            .type = "application/json",
            .body = body};
  }
  Response post(const std::string& body) { return ask(posting(body)); }
  json done(const std::string& what) { return json::parse(*post(R"({"do": ")" + what + "\"}").body); }

  pipeline::FakeDesk* desk_ = nullptr;
  std::unique_ptr<DeskService> service_;
};

TEST_F(DeskServiceThread, ThePageMayTalkWithItsServerAlone) {
  serve();
  const auto page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_TRUE(page.admitted);
  EXPECT_THAT(*page.body, HasSubstr("nonce=\"0123\""));
  EXPECT_THAT(*page.body, HasSubstr("connect-src 'self'"));
  EXPECT_EQ(get("/style.css").status, 200);
  EXPECT_EQ(get("/api/live").status, 404);
  EXPECT_EQ(get("/trial/1").status, 404);
}

TEST_F(DeskServiceThread, ATrialGoesFromItsSetUpToAFile) {
  serve();
  EXPECT_EQ(json::parse(*get("/api/desk").body)["step"], "plan");
  const auto started = json::parse(*post(R"({"do": "start", "leds": "3", "trial": "reach"})").body);
  EXPECT_EQ(started["step"], "live");
  EXPECT_EQ(started["granted"]["rate_hz"], 138.0);
  EXPECT_EQ(done("record")["step"], "recording");
  const auto check = done("stop");
  EXPECT_EQ(check["step"], "check");
  EXPECT_EQ(check["check"][0]["text"], "No frame was lost");
  const auto kept = done("keep");
  EXPECT_EQ(kept["message"], "Kept: raw/reach.mcap");
  EXPECT_EQ(kept["wanted"]["trial"], "reach_02");
}

TEST_F(DeskServiceThread, WhatTheDeviceRefusesIsTheMessage) {
  serve();
  const auto answer = post(R"({"do": "start", "rate_hz": "500"})");
  EXPECT_EQ(answer.status, 200);
  const auto state = json::parse(*answer.body);
  EXPECT_EQ(state["step"], "plan");
  EXPECT_THAT(state["message"].get<std::string>(), HasSubstr("the highest rate is 138 Hz"));
}

TEST_F(DeskServiceThread, WhatIsNoRequestIsRefusedInASentence) {
  serve();
  EXPECT_EQ(post(R"({"do": "fly"})").status, 400);
  EXPECT_THAT(*post("x").body, HasSubstr("error"));
  auto request = posting(R"({"do": "look"})");
  request.type = "text/plain";
  EXPECT_EQ(ask(request).status, 415);
  request = posting(R"({"do": "look"})");
  request.target = "/s/";
  EXPECT_EQ(ask(request).status, 405);
  EXPECT_EQ(json::parse(*get("/api/desk").body)["step"], "plan") << "nothing was done";
}

TEST_F(DeskServiceThread, StrangersGetNothingAndDoNothing) {
  serve();
  auto request = posting(R"({"do": "start"})");
  request.origin = "http://evil.example";
  EXPECT_EQ(ask(request).status, 403);
  request = posting(R"({"do": "start"})");
  request.target = "/wrong/api/desk";
  EXPECT_EQ(ask(request).status, 401);
  EXPECT_EQ(json::parse(*get("/api/desk").body)["step"], "plan");
}

TEST_F(DeskServiceThread, ATrialWhoseTimeIsUpEndsWithoutAPage) {
  std::promise<void> over;
  bool answered = false;
  // Asked after each look at the trial, on the thread that has the session.
  serve(pipeline::for_seconds("5"), [this, &over, &answered] {
    const bool ended = !desk_->calls.empty() && desk_->calls.back() == "stop";
    if (!desk_->calls.empty() && desk_->calls.back() == "record") desk_->now.recorded_s = 5.0;
    if (ended && !std::exchange(answered, true)) over.set_value();
    return false;
  });
  (void)done("start");
  EXPECT_EQ(done("record")["step"], "recording");
  over.get_future().wait();
  EXPECT_EQ(json::parse(*get("/api/desk").body)["step"], "check");
}

TEST_F(DeskServiceThread, ATrialIsKeptWhenTheProgramEnds) {
  std::promise<std::size_t> ended;
  std::atomic<bool> stop = false;
  serve(
      pipeline::rig_at(), [&stop] { return stop.load(); },
      [&ended](const pipeline::DeskState& left) { ended.set_value(left.kept.size()); });
  (void)done("start");
  (void)done("record");
  stop = true;
  EXPECT_EQ(ended.get_future().get(), 1U);
  const auto state = json::parse(*get("/api/desk").body);
  EXPECT_EQ(state["step"], "ended");
  EXPECT_EQ(state["kept"].size(), 1U);
  EXPECT_EQ(done("record")["step"], "ended");
}

}  // namespace
}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_service.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kinemark/stream/recorded_source.h"
#include "server/testing/fake_clock.h"

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;

class LiveServiceThread : public ::testing::Test {
 protected:
  LiveServiceThread() {
    auto markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 10});
    auto feed = LiveFeed::create({.source = std::make_unique<stream::RecordedSource>(
                                      std::move(markers), stream::SourceFacts{.name = "test"}),
                                  .most_viewers = 1,
                                  .clock = std::make_shared<testing::FakeClock>(),
                                  .say = [](std::string_view) {}})
                    .value();
    feed_ = feed.get();
    service_ = std::make_unique<LiveService>(
        Keys{.hosts = {"127.0.0.1:1", "localhost:1"}, .token = "t", .session = "s"},
        "<meta content=\"default-src 'none'; x\"><style>a</style><script type=\"module\">b</script>", "0123",
        std::move(feed));
  }

  Response ask(const Request& request) {
    std::optional<Response> answer;
    service_->handle(request, [&answer](Response response) { answer = std::move(response); });
    return answer.value();
  }
  Response get(const std::string& target) {
    return ask({.method = "GET", .target = "/s" + target, .host = "127.0.0.1:1"});
  }
  static Request upgrade() {
    return {.method = "GET",
            .target = "/s/live/socket",
            .host = "127.0.0.1:1",
            .origin = "http://127.0.0.1:1",
            .upgrade = true};
  }
  static std::string header(const Response& response, const std::string& name) {
    for (const auto& [key, value] : response.headers)
      if (key == name) return value;
    return "";
  }

  std::unique_ptr<LiveService> service_;
  LiveFeed* feed_ = nullptr;
};

TEST_F(LiveServiceThread, ThePageMayTalkWithItsServerAlone) {
  const auto page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_TRUE(page.admitted);
  EXPECT_THAT(*page.body, HasSubstr("nonce=\"0123\""));
  EXPECT_THAT(*page.body, HasSubstr("default-src 'none'; connect-src 'self'; x"));
  EXPECT_THAT(header(page, "Content-Security-Policy"), HasSubstr("connect-src 'self'; "));
  EXPECT_THAT(header(page, "Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(header(page, "X-Content-Type-Options"), "nosniff");
}

TEST_F(LiveServiceThread, SaysHowItGoes) {
  feed_->wait();
  const auto json = nlohmann::json::parse(*get("/api/live").body);
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["of_frames"], 10);
  EXPECT_EQ(json["ended"], true);
  EXPECT_EQ(json["viewers"].size(), 0U);
}

TEST_F(LiveServiceThread, EverythingElseIsNotThere) {
  for (const char* const target : {"/live/socket", "/trial/1", "/live", "/api/trials", "/../etc/passwd"}) {
    const auto response = get(target);
    EXPECT_EQ(response.status, 404) << target;
    EXPECT_EQ(response.socket, nullptr);
  }
  auto request = upgrade();
  request.target = "/s/";
  EXPECT_EQ(ask(request).status, 404);
}

TEST_F(LiveServiceThread, ASocketIsForPagesOfThisServerBelowItsSession) {
  auto request = upgrade();
  request.origin = "http://evil.example";
  EXPECT_EQ(ask(request).status, 403);
  request = upgrade();
  request.origin = std::nullopt;
  EXPECT_EQ(ask(request).status, 403);
  request = upgrade();
  request.target = "/live/socket";
  EXPECT_EQ(ask(request).status, 401);
  request = upgrade();
  request.target = "/wrong/live/socket";
  EXPECT_EQ(ask(request).status, 401);
  request = upgrade();
  request.host = "evil.example";
  EXPECT_EQ(ask(request).status, 421);
  request = upgrade();
  request.method = "POST";
  EXPECT_EQ(ask(request).socket, nullptr);
  EXPECT_NE(ask(upgrade()).socket, nullptr);
}

TEST_F(LiveServiceThread, TooManyViewersAreASentence) {
  const auto first = ask(upgrade());
  ASSERT_NE(first.socket, nullptr);
  const auto second = ask(upgrade());
  EXPECT_EQ(second.status, 503);
  EXPECT_EQ(second.socket, nullptr);
  EXPECT_THAT(*second.body, HasSubstr("close another page"));
}

TEST(LiveStateJson, NamesWhatItSays) {
  const auto json =
      nlohmann::json::parse(live_state_json({.frames = 7,
                                             .of_frames = 9,
                                             .recorded = 6,
                                             .unsolved = 1,
                                             .viewers = {{.sent = 5, .dropped = 2, .most_ms = 1.5}}}));
  EXPECT_EQ(json["of_frames"], 9);
  EXPECT_EQ(json["recorded"], 6);
  EXPECT_EQ(json["unsolved"], 1);
  EXPECT_EQ(json["ended"], false);
  EXPECT_EQ(json["viewers"][0]["dropped"], 2);
  EXPECT_EQ(json["viewers"][0]["to_socket_ms"]["p99"], 1.5);
  EXPECT_TRUE(nlohmann::json::parse(live_state_json({}))["of_frames"].is_null()) << "nobody knows";
}

}  // namespace
}  // namespace kinemark::server

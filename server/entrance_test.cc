// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/entrance.h"

#include <gmock/gmock.h>

#include <bit>
#include <map>
#include <set>

namespace kinemark::server {
namespace {

using ::testing::MatchesRegex;

TEST(Secret, Has128BitsThatAreNeverTheSame) {
  std::set<std::string> seen;
  int ones = 0;
  constexpr int kCount = 500;
  for (int i = 0; i < kCount; ++i) {
    const auto secret = new_secret().value();
    ASSERT_EQ(secret.size(), 32U);
    ASSERT_THAT(secret, MatchesRegex("[0-9a-f]+"));
    EXPECT_TRUE(seen.insert(secret).second);
    for (const char digit : secret)
      ones += std::popcount(static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10));
  }
  // Bits of a fair coin: 64,000 of them, whose standard deviation is 126.
  EXPECT_NEAR(ones, kCount * 64, 6 * 126);
}

TEST(Secret, IsTheSameOnlyWithEveryLetter) {
  const std::string secret = "0123456789abcdef0123456789abcdef";
  EXPECT_TRUE(same_secret(secret, secret));
  for (std::size_t i = 0; i < secret.size(); ++i) {
    auto other = secret;
    other[i] = 'x';
    EXPECT_FALSE(same_secret(other, secret)) << i;
  }
}

TEST(Secret, IsNotAPartOrARepetition) {
  const std::string secret = "0123456789abcdef";
  EXPECT_FALSE(same_secret("", secret));
  EXPECT_FALSE(same_secret("0123456789abcde", secret));
  EXPECT_FALSE(same_secret(secret + secret, secret));
  EXPECT_FALSE(same_secret(secret + '\0', secret));
  EXPECT_FALSE(same_secret("0123456789ABCDEF", secret));
}

TEST(Secret, NothingEqualsAnEmptyOne) {
  EXPECT_FALSE(same_secret("", ""));
  EXPECT_FALSE(same_secret("a", ""));
}

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kToken = "11111111111111111111111111111111";
constexpr const char* kOpening = "22222222222222222222222222222222";
constexpr const char* kSession = "33333333333333333333333333333333";
constexpr const char* kHost = "127.0.0.1:8123";
constexpr const char* kOrigin = "http://127.0.0.1:8123";

Keys keys() {
  return {.hosts = {kHost, "localhost:8123"}, .token = kToken, .opening = kOpening, .session = kSession};
}

class AskEntrance : public ::testing::Test {
 protected:
  /// Of a page below the session.
  static Request known(const std::string& target = "/") {
    return {.method = "GET", .target = std::string("/") + kSession + target, .host = kHost};
  }
  static Request unknown(const std::string& target = "/") {
    return {.method = "GET", .target = target, .host = kHost};
  }
  /// Status of the refusal; 0: let in.
  int status(Request request) {
    const auto response = entrance_.ask(request);
    return response ? response->status : 0;
  }
  Entrance entrance_{keys()};
};

std::string header(const Response& response, const std::string& name);

TEST(EntranceOverTls, TakesPagesOfHttpsAlone) {
  auto secured = keys();
  secured.tls = true;
  Entrance entrance(secured);
  Request request{.method = "POST", .target = std::string("/") + kSession + "/x", .host = kHost};
  request.origin = std::string("http://") + kHost;
  EXPECT_EQ(entrance.ask(request)->status, 403);
  request.origin = std::string("https://") + kHost;
  EXPECT_FALSE(entrance.ask(request));
}

std::string header(const Response& response, const std::string& name) {
  for (const auto& [key, value] : response.headers)
    if (key == name) return value;
  return "";
}

TEST_F(AskEntrance, LetsInWhoAsksBelowTheSession) {
  auto request = known("/trial/1");
  request.host = "LocalHost:8123";
  EXPECT_FALSE(entrance_.ask(request));
  EXPECT_EQ(request.target, "/trial/1") << "the session is taken off";
  request = known();
  EXPECT_FALSE(entrance_.ask(request));
  EXPECT_EQ(request.target, "/");
}

TEST_F(AskEntrance, AForeignHostIsMisdirectedWhateverItHas) {
  for (const char* host :
       {"evil.example:8123", "127.0.0.1", "127.0.0.1:81", "127.0.0.1:8123.evil.example", "", "localhost",
        "127.0.0.1:8123, 127.0.0.1:8123", " 127.0.0.1:8123", "[::1]:8123", "user@127.0.0.1:8123"}) {
    auto request = known();
    request.host = host;
    EXPECT_EQ(status(request), 421) << host;
    request = unknown(std::string("/?token=") + kToken);
    request.host = host;
    EXPECT_EQ(status(request), 421) << host;
  }
  auto request = known();
  request.host.reset();
  EXPECT_EQ(status(request), 421);
}

TEST_F(AskEntrance, AnythingButReadingNeedsOurOrigin) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "BREW", "get"}) {
    auto request = known();
    request.method = method;
    EXPECT_EQ(status(request), 403) << method;
    for (const char* origin : {"http://evil.example", "null", "", "https://127.0.0.1:8123",
                               "http://127.0.0.1", "http://127.0.0.1:8123/", "http://localhost:8123"}) {
      request.origin = origin;
      EXPECT_EQ(status(request), 403) << method << " from " << origin;
    }
    request.origin = kOrigin;
    EXPECT_EQ(status(request), std::string(method) == "POST" ? 0 : 405) << method;
  }
}

TEST_F(AskEntrance, AWebSocketNeedsOurOrigin) {
  auto request = known("/trial/1");
  request.upgrade = true;
  EXPECT_EQ(status(request), 403);
  request.origin = "http://evil.example";
  EXPECT_EQ(status(request), 403);
  request.origin = kOrigin;
  EXPECT_EQ(status(request), 0);
  for (const char* method : {"HEAD", "POST", "GE"}) {
    request.method = method;
    EXPECT_EQ(status(request), 405) << method;
  }
  request.method = "GET";
  request.target = "/trial/1";
  EXPECT_EQ(status(request), 401);
}

TEST_F(AskEntrance, ReadingNeedsNoOrigin) {
  for (const char* method : {"GET", "HEAD"}) {
    auto request = known();
    request.method = method;
    EXPECT_EQ(status(request), 0);
  }
}

TEST_F(AskEntrance, WithoutTheSecretNothingIsShown) {
  EXPECT_EQ(status(unknown()), 401);
  EXPECT_EQ(status(unknown("/style.css")), 401);
  EXPECT_EQ(status(unknown("/nothing")), 401) << "what there is is not shown either";
  const std::string session = kSession;
  for (const std::string& target :
       {std::string("//"), "/" + session, "/" + session.substr(1) + "/", "/" + session + "3/", session + "/",
        "//" + session + "/", std::string("/") + kToken + "/", std::string("/") + kOpening + "/",
        "/?" + session + "/", "/trial/1/" + session + "/", std::string(), std::string("*"),
        "http://" + std::string(kHost) + "/" + session + "/"})
    EXPECT_EQ(status(unknown(target)), 401) << target;
  auto request = unknown();
  const auto response = entrance_.ask(request).value();
  EXPECT_FALSE(response.admitted);
  EXPECT_THAT(header(response, "WWW-Authenticate"), HasSubstr("Bearer"));
  EXPECT_THAT(*response.body, HasSubstr("kinemark serve"));
}

TEST_F(AskEntrance, TheTokenIsExchangedForTheSessionAndLeavesTheAddress) {
  for (int i = 0; i < 2; ++i) {
    auto request = unknown(std::string("/?token=") + kToken);
    const auto response = entrance_.ask(request).value();
    EXPECT_EQ(response.status, 303);
    EXPECT_TRUE(response.admitted);
    EXPECT_EQ(header(response, "Location"), std::string("/") + kSession + "/");
    EXPECT_EQ(header(response, "Set-Cookie"), "") << "a cookie goes to every port of the machine";
  }
}

TEST_F(AskEntrance, AWrongTokenIsNoToken) {
  for (const char* token : {"", "1", "11111111111111111111111111111112", "1111111111111111111111111111111",
                            "111111111111111111111111111111111", "33333333333333333333333333333333"})
    EXPECT_EQ(status(unknown(std::string("/?token=") + token)), 401) << token;
  EXPECT_EQ(status(unknown(std::string("/?token=") + kToken + "&x=1")), 401);
  EXPECT_EQ(status(unknown(std::string("/trial/1?token=") + kToken)), 401);
}

TEST_F(AskEntrance, TheTokenOfTheBrowserThatIsOpenedIsGoodOnce) {
  EXPECT_EQ(status(unknown(std::string("/?token=") + kOpening)), 303);
  EXPECT_EQ(status(unknown(std::string("/?token=") + kOpening)), 401);
  EXPECT_EQ(status(unknown("/?token=")), 401);
}

TEST_F(AskEntrance, TheTokenIsTakenOnlyByReading) {
  auto request = unknown(std::string("/?token=") + kToken);
  request.method = "HEAD";
  EXPECT_EQ(status(request), 401);
  request.method = "POST";
  request.origin = kOrigin;
  EXPECT_EQ(status(request), 401);
}

TEST_F(AskEntrance, AProgramSendsTheTokenItself) {
  auto request = unknown("/api/trials");
  request.authorization = std::string("Bearer ") + kToken;
  EXPECT_EQ(status(request), 0);
  for (const std::string& wrong :
       {std::string("Bearer ") + kOpening, std::string("Bearer ") + kSession, std::string("Basic ") + kToken,
        std::string(kToken), std::string("Bearer ")}) {
    request.authorization = wrong;
    EXPECT_EQ(status(request), 401) << wrong;
  }
}

TEST(SentencePage, IsText) {
  const auto response = sentence_page(404, "<script>alert(1)</script> & \"more\"");
  EXPECT_EQ(response.status, 404);
  EXPECT_EQ(response.type, "text/plain; charset=utf-8");
  EXPECT_EQ(*response.body, "kinemark: <script>alert(1)</script> & \"more\"\n");
}

TEST(SafeHeaders, AreOnEveryResponseAndKeepAPolicyOfItsOwn) {
  Response response;
  add_safe_headers(response);
  const std::map<std::string, std::string> all(response.headers.begin(), response.headers.end());
  EXPECT_EQ(all.at("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(all.at("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(all.at("Cache-Control"), "no-store");
  EXPECT_THAT(all.at("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_THAT(all.at("Content-Security-Policy"), HasSubstr("frame-ancestors 'none'"));
  EXPECT_EQ(all.size(), response.headers.size()) << "none twice";

  Response own{.headers = {{"Content-Security-Policy", "mine"}}};
  add_safe_headers(own);
  EXPECT_EQ(header(own, "Content-Security-Policy"), "mine");
  EXPECT_EQ(own.headers.size(), response.headers.size());
}

}  // namespace

}  // namespace kinemark::server

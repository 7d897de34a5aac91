// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/http_server.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "server/testing/client.h"

namespace kinemark::server {
namespace {

using testing::Client;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string get(const std::string& target, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: x\r\n" + more + "\r\n";
}

/// A server that admits whoever asks for "/friend", and shows what it understood.
class HttpThread : public ::testing::Test {
 protected:
  void start(const HttpLimits& limits = {}) {
    server_ = HttpServer::listen("127.0.0.1", 0, limits).value();
    thread_ = std::thread([this] {
      server_->run([this](const Request& request, const Reply& reply) {
        if (request.target == "/friend/held") held_ = reply;
        ++asked_;
        if (request.target == "/friend/held") return;
        Response response{.type = "text/plain", .admitted = request.target.starts_with("/friend")};
        response.body = std::make_shared<const std::string>(
            request.method + "|" + request.target + "|" + request.host.value_or("none") + "|" +
            request.origin.value_or("none") + "|" + request.authorization + "|" +
            (request.upgrade ? "upgrade" : "plain") + request.type + request.body);
        if (request.target == "/friend/large")
          response.body = std::make_shared<const std::string>(8UL << 20, 'x');
        if (request.target == "/friend/later") {
          later_ = std::thread([reply, response] { reply(response); });
          return;
        }
        reply(std::move(response));
      });
    });
  }
  void TearDown() override {
    if (later_.joinable()) later_.join();
    if (server_) server_->stop();
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] Client connect() const { return Client(server_->port()); }
  [[nodiscard]] std::string ask(const std::string& request) const {
    const auto client = connect();
    client.send(request);
    return client.read_all();
  }

  std::atomic<int> asked_ = 0;
  std::unique_ptr<HttpServer> server_;
  Reply held_;  ///< of a request that the test answers
  std::thread thread_, later_;
};

TEST_F(HttpThread, UnderstandsWhatDecides) {
  start();
  EXPECT_THAT(ask(get("/a?b", "Origin: http://o\r\nAuthorization: Bearer t\r\n")),
              ::testing::EndsWith("GET|/a?b|x|http://o|Bearer t|plain"));
  EXPECT_THAT(ask(get("/",
                      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Key: x\r\n"
                      "Sec-WebSocket-Version: 13\r\n")),
              ::testing::EndsWith("|upgrade"));
  EXPECT_THAT(ask("GET / HTTP/1.0\r\n\r\n"), ::testing::EndsWith("GET|/|none|none||plain"));
  EXPECT_THAT(ask(get("/", "Origin: http://a\r\nOrigin: http://b\r\n")), HasSubstr("|http://a, http://b|"));
}

TEST_F(HttpThread, BodiesAreAsTheyWereSent) {
  start();
  const std::string body("{\"a\":\"\xc3\xa4\0\r\n\r\n\"}", 15);
  EXPECT_THAT(ask("POST /x HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Type: application/json\r\n"
                  "Content-Length: " +
                  std::to_string(body.size()) + "\r\n\r\n" + body),
              ::testing::EndsWith("POST|/x|x|none||plainapplication/json" + body));
  EXPECT_THAT(ask("POST / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Type: a\r\n"
                  "Content-Type: b\r\nContent-Length: 1\r\n\r\n1"),
              ::testing::EndsWith("plaina, b1"))
      << "two types are none of them";
}

TEST_F(HttpThread, TwoHostsAreNone) {
  start();
  EXPECT_THAT(ask(get("/", "Host: y\r\n")), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(asked_, 0);
}

TEST_F(HttpThread, AFriendKeepsTheConnectionAStrangerDoesNot) {
  start();
  const auto client = connect();
  for (int i = 0; i < 3; ++i) {
    client.send(get("/friend"));
    EXPECT_THAT(client.read_one(), StartsWith("HTTP/1.1 200"));
  }
  client.send(get("/stranger"));
  const auto last = client.read_all();
  EXPECT_THAT(last, HasSubstr("Connection: close"));
  EXPECT_EQ(asked_, 4);
}

TEST_F(HttpThread, SeveralRequestsAtOnceAreAnsweredInTurn) {
  start();
  const auto client = connect();
  client.send(get("/friend/1") + get("/friend/2") + get("/last", "Connection: close\r\n"));
  const auto all = client.read_all();
  EXPECT_LT(all.find("/friend/1|"), all.find("/friend/2|"));
  EXPECT_LT(all.find("/friend/2|"), all.find("/last|"));
}

TEST_F(HttpThread, HeadHasTheLengthAndNoBody) {
  start();
  const auto answer = ask("HEAD / HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_THAT(answer, HasSubstr("Content-Length: 20\r\n"));
  EXPECT_THAT(answer, ::testing::EndsWith("\r\n\r\n"));
}

TEST_F(HttpThread, AnAnswerMayComeFromAnotherThread) {
  start();
  const auto client = connect();
  client.send(get("/friend/later"));
  EXPECT_THAT(client.read_one(), ::testing::EndsWith("GET|/friend/later|x|none||plain"));
}

TEST_F(HttpThread, ALargeAnswerIsWhole) {
  start();
  const auto client = connect();
  client.send(get("/friend/large"));
  const auto answer = client.read_one();
  EXPECT_EQ(answer.size() - answer.find("\r\n\r\n") - 4, 8UL << 20);
}

TEST_F(HttpThread, WhatIsTooLongIsRefusedWithItsStatus) {
  start({.header_bytes = 1000, .body_bytes = 100});
  EXPECT_THAT(ask(get("/", "X: " + std::string(2'000, 'a') + "\r\n")), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(ask(get("/" + std::string(100'000, 'a'))), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(ask("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 101\r\n\r\n" + std::string(101, 'a')),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(ask("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 18446744073709551615\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(ask("POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nffffff\r\n" +
                  std::string(200, 'a')),
              StartsWith("HTTP/1.1 413"));
  EXPECT_EQ(asked_, 0);
  EXPECT_THAT(ask("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n" + std::string(100, 'a')),
              StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpThread, WhatIsNoHttpIsRefused) {
  start();
  for (const char* const text :
       {"\x16\x03\x01\x02\x01\x01\xfc\x03\x03 TLS\r\n\r\n", "GET\r\n\r\n", "GET / FTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost\r\n\r\n", "GET / HTTP/1.1\r\n: x\r\n\r\n",
        "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
        "GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
        "GET /\x01 HTTP/1.1\r\nHost: x\r\n\r\n"})
    EXPECT_THAT(ask(text), StartsWith("HTTP/1.1 400")) << text;
  EXPECT_EQ(asked_, 0);
}

TEST_F(HttpThread, AClientThatSaysNothingIsLetGo) {
  start({.request = std::chrono::milliseconds(50)});
  const auto silent = connect();
  EXPECT_EQ(silent.read_all(), "");
  const auto slow = connect();
  slow.send("GET / HTTP/1.1\r\nHost:");
  EXPECT_EQ(slow.read_all(), "");
  EXPECT_EQ(asked_, 0);
}

TEST_F(HttpThread, AFriendThatSaysNothingMoreIsLetGoToo) {
  start({.idle = std::chrono::milliseconds(50)});
  const auto client = connect();
  client.send(get("/friend"));
  EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpThread, AFriendThatTakesNothingIsLetGo) {
  start({.response = std::chrono::milliseconds(50)});
  const auto client = connect();
  client.send(get("/friend/large"));
  while (asked_ == 0) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  for (int i = 0; i < 3; ++i)
    EXPECT_THAT(ask(get("/")), StartsWith("HTTP/1.1 200")) << "the time of the other one is over by now";
  EXPECT_LT(client.read_all().size(), 8UL << 20);
}

TEST_F(HttpThread, HoldingConnectionsKeepsNobodyOut) {
  start({.strangers = 8, .request = std::chrono::hours(1)});
  std::vector<Client> holding;
  for (int i = 0; i < 100; ++i) {
    holding.push_back(connect());
    holding.back().send("GET / HTTP/1.1\r\nX: ");
  }
  EXPECT_THAT(ask(get("/")), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(holding.front().read_all(), "") << "the oldest went";
}

TEST_F(HttpThread, AFriendStaysWhenStrangersCome) {
  start({.strangers = 4, .request = std::chrono::hours(1)});
  const auto client = connect();
  client.send(get("/friend"));
  (void)client.read_one();
  std::vector<Client> strangers;
  for (int i = 0; i < 50; ++i) {
    strangers.push_back(connect());
    strangers.back().send("GET ");
  }
  EXPECT_THAT(ask(get("/")), StartsWith("HTTP/1.1 200"));
  client.send(get("/friend"));
  EXPECT_THAT(client.read_one(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpThread, WhoWaitsForAnAnswerStaysWhenStrangersCome) {
  start({.strangers = 4, .request = std::chrono::hours(1)});
  const auto client = connect();
  client.send(get("/friend/held"));
  while (asked_ == 0) std::this_thread::yield();
  std::vector<Client> strangers;
  for (int i = 0; i < 50; ++i) {
    strangers.push_back(connect());
    strangers.back().send("GET ");
  }
  EXPECT_THAT(ask(get("/")), StartsWith("HTTP/1.1 200"));
  held_(Response{.type = "text/plain", .admitted = true});
  EXPECT_THAT(client.read_one(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpThread, FriendsAreNotWithoutNumber) {
  start({.friends = 2});
  std::vector<Client> friends;
  for (int i = 0; i < 3; ++i) {
    friends.push_back(connect());
    friends.back().send(get("/friend"));
    EXPECT_THAT(friends.back().read_one(), StartsWith("HTTP/1.1 200"));
  }
  EXPECT_EQ(friends[0].read_all(), "");
  for (std::size_t i = 1; i < 3; ++i) {
    friends[i].send(get("/friend"));
    EXPECT_THAT(friends[i].read_one(), StartsWith("HTTP/1.1 200"));
  }
}

TEST_F(HttpThread, AClientThatGoesInTheMiddleIsForgotten) {
  start();
  for (int i = 0; i < 20; ++i) {
    const auto client = connect();
    client.send(i % 2 == 0 ? get("/friend/large") : "GET / HT");
    if (i % 3 == 0) client.end_sending();
  }
  EXPECT_THAT(ask(get("/")), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpThread, APortThatIsTakenIsASentence) {
  start();
  const auto second = HttpServer::listen("127.0.0.1", server_->port());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Code::io);
  EXPECT_THAT(second.error().message, HasSubstr("127.0.0.1 port "));
  EXPECT_FALSE(HttpServer::listen("nowhere", 0));
}

TEST_F(HttpThread, RefusalsSayNothingOfTheProgram) {
  start();
  const auto answer = ask("nonsense\r\n\r\n");
  EXPECT_THAT(answer, Not(HasSubstr("Server:")));
  EXPECT_THAT(answer, HasSubstr("Connection: close"));
}

}  // namespace
}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The side of RFC 6455 that a client sees, over sockets of this machine.
#include <gmock/gmock.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "server/http_server.h"
#include "server/socket_peer.h"
#include "server/testing/web_client.h"

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using testing::WebClient;

/// Says what it is given, repeats what it hears, and ends at "end" and when it does not understand "?".
class Echo : public SocketPeer {
 public:
  void opened(std::function<void()> wake) override {
    const std::scoped_lock lock(mutex_);
    wake_ = std::move(wake);
    changed_.notify_all();
  }
  std::shared_ptr<const std::string> next() override {
    const std::scoped_lock lock(mutex_);
    if (waiting_.empty()) return nullptr;
    auto first = std::move(waiting_.front());
    waiting_.pop_front();
    return std::make_shared<const std::string>(std::move(first));
  }
  void sent() override {
    const std::scoped_lock lock(mutex_);
    ++sent_;
  }
  std::optional<SocketEnd> end() override {
    const std::scoped_lock lock(mutex_);
    return ends_ ? std::optional(SocketEnd{.code = 1000, .reason = "that was all"}) : std::nullopt;
  }
  bool heard(std::string_view bytes) override {
    const std::scoped_lock lock(mutex_);
    if (bytes == "end") ends_ = true;
    if (bytes != "?") waiting_.emplace_back(bytes);
    return bytes != "?";
  }
  void closed() override {
    const std::scoped_lock lock(mutex_);
    ++closed_;
    wake_ = nullptr;
    changed_.notify_all();
  }

  /// From another thread than the server's.
  void say(const std::string& text) {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(text);
    if (wake_) wake_();
  }
  void wait_until_open() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return wake_ != nullptr; });
  }
  void wait_until_closed() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ > 0; });
  }
  [[nodiscard]] int times_closed() {
    const std::scoped_lock lock(mutex_);
    return closed_;
  }
  [[nodiscard]] int messages_sent() {
    const std::scoped_lock lock(mutex_);
    return sent_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> waiting_;
  std::function<void()> wake_;
  bool ends_ = false;
  int closed_ = 0, sent_ = 0;
};

/// A server that gives whoever asks for a WebSocket an Echo.
class WebSocketThread : public ::testing::Test {
 protected:
  void start(const HttpLimits& limits = {}) {
    server_ = HttpServer::listen("127.0.0.1", 0, limits).value();
    thread_ = std::thread([this] {
      server_->run([this](const Request& request, const Reply& reply) {
        Response response{.type = "text/plain", .admitted = true};
        response.body = std::make_shared<const std::string>("plain");
        if (request.upgrade) response.socket = echo_;
        reply(std::move(response));
      });
    });
  }
  void TearDown() override {
    if (server_) server_->stop();
    if (thread_.joinable()) thread_.join();
    server_.reset();
    EXPECT_LE(echo_->times_closed(), 1);
  }
  [[nodiscard]] WebClient opened() const {
    WebClient client(server_->port());
    EXPECT_THAT(client.open("/echo"), StartsWith("HTTP/1.1 101"));
    return client;
  }

  std::shared_ptr<Echo> echo_ = std::make_shared<Echo>();
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
};

TEST_F(WebSocketThread, IsAcceptedAsTheStandardSays) {
  start();
  const WebClient client(server_->port());
  const auto head = client.open("/echo");
  EXPECT_THAT(head, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(head, HasSubstr("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"));
  EXPECT_THAT(head, Not(HasSubstr("Boost")));
}

TEST_F(WebSocketThread, WhatIsNoSoundRequestForOneGetsNone) {
  start();
  for (const char* const headers :
       {"Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 12\r\nSec-WebSocket-Key: "
        "dGhlIHNhbXBsZSBub25jZQ==\r\n",
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n",
        "Connection: Upgrade\r\nUpgrade: h2c\r\n"}) {
    const WebClient client(server_->port());
    echo_ = std::make_shared<Echo>();
    EXPECT_THAT(client.open("/echo", headers), Not(HasSubstr(" 101 "))) << headers;
    echo_->wait_until_closed();
  }
}

TEST_F(WebSocketThread, MessagesGoBothWaysInOrder) {
  start();
  const auto client = opened();
  client.say(2, "one");
  client.say(2, "two");
  EXPECT_EQ(client.hear().bytes, "one");
  const auto second = client.hear();
  EXPECT_EQ(second.kind, 2);
  EXPECT_EQ(second.bytes, "two");
}

TEST_F(WebSocketThread, AnotherThreadWakesIt) {
  start();
  const auto client = opened();
  echo_->wait_until_open();
  for (int i = 0; i < 100; ++i) echo_->say(std::to_string(i));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(client.hear().bytes, std::to_string(i));
  client.say(2, "");
  (void)client.hear();
  EXPECT_GE(echo_->messages_sent(), 100);
}

TEST_F(WebSocketThread, ALargeMessageIsWhole) {
  start();
  const auto client = opened();
  echo_->wait_until_open();
  const std::string large(5'000'000, 'x');
  echo_->say(large);
  EXPECT_EQ(client.hear().bytes, large);
}

TEST_F(WebSocketThread, EndsWithACodeAndAReason) {
  start({.farewell = std::chrono::milliseconds(50)});
  const auto client = opened();
  client.say(2, "end");
  EXPECT_EQ(client.hear().bytes, "end");
  const auto close = client.hear();
  EXPECT_EQ(close.kind, 8);
  EXPECT_EQ(close.code(), 1000);
  EXPECT_EQ(close.bytes.substr(2), "that was all");
  client.say(8, close.bytes);
  EXPECT_EQ(client.read_all(), "");
  echo_->wait_until_closed();
}

TEST_F(WebSocketThread, WhatIsNotUnderstoodEndsIt) {
  start({.farewell = std::chrono::milliseconds(50)});
  for (const auto& [kind, text, mask, code] :
       {std::tuple(2, std::string("?"), true, 1008), std::tuple(1, std::string("text"), true, 1008),
        std::tuple(2, std::string(65, 'x'), true, 1009),
        std::tuple(2, std::string(1'000'000, 'x'), true, 1009), std::tuple(2, std::string("x"), false, 1002),
        std::tuple(3, std::string("x"), true, 1002)}) {
    echo_ = std::make_shared<Echo>();
    const auto client = opened();
    client.say(kind, text, mask);
    EXPECT_EQ(client.hear().code(), code) << kind << " " << text.size();
    client.say(8, "");
    echo_->wait_until_closed();
  }
}

TEST_F(WebSocketThread, AMessageOfTheLargestSizeIsHeard) {
  start({.message_bytes = 5});
  const auto client = opened();
  client.say(2, "12345");
  EXPECT_EQ(client.hear().bytes, "12345");
  client.say(2, "123456");
  EXPECT_EQ(client.hear().code(), 1009);
}

TEST_F(WebSocketThread, APingIsAnswered) {
  start();
  const auto client = opened();
  client.say(9, "there?");
  const auto pong = client.hear();
  EXPECT_EQ(pong.kind, 10);
  EXPECT_EQ(pong.bytes, "there?");
}

TEST_F(WebSocketThread, WhoAnswersNoPingIsLetGo) {
  start({.silence = std::chrono::milliseconds(100)});
  const auto client = opened();
  EXPECT_EQ(client.hear().kind, 9);
  while (client.hear().kind != 0) continue;
  echo_->wait_until_closed();
}

TEST_F(WebSocketThread, WhoGoesInTheMiddleIsForgotten) {
  start();
  for (int i = 0; i < 10; ++i) {
    echo_ = std::make_shared<Echo>();
    {
      const auto client = opened();
      echo_->wait_until_open();
      echo_->say(std::string(1'000'000, 'x'));
    }
    echo_->wait_until_closed();
  }
}

TEST_F(WebSocketThread, TheServerEndsWhileSomeAreOpen) {
  start();
  const auto client = opened();
  echo_->wait_until_open();
  server_->stop();
  thread_.join();
  server_.reset();
  EXPECT_EQ(echo_->times_closed(), 1);
  EXPECT_THAT(client.read_all(), IsEmpty());
}

TEST_F(WebSocketThread, TheyCountAmongFriends) {
  start({.friends = 2});
  std::vector<std::shared_ptr<Echo>> echoes;
  std::vector<WebClient> clients;
  for (int i = 0; i < 3; ++i) {
    echoes.push_back(echo_ = std::make_shared<Echo>());
    clients.push_back(opened());
    echo_->wait_until_open();
  }
  echoes[0]->wait_until_closed();
  EXPECT_EQ(clients[0].read_all(), "");
  clients[2].say(2, "still here");
  EXPECT_EQ(clients[2].hear().bytes, "still here");
}

TEST_F(WebSocketThread, StrangersPushNoneOut) {
  start({.strangers = 4, .request = std::chrono::hours(1)});
  const auto client = opened();
  std::vector<WebClient> strangers;
  for (int i = 0; i < 50; ++i) {
    strangers.emplace_back(server_->port());
    strangers.back().send("GET /echo HTTP/1.1\r\nUpgrade: websocket\r\nSec-WebSock");
  }
  client.say(2, "still here");
  EXPECT_EQ(client.hear().bytes, "still here");
}

}  // namespace
}  // namespace kinemark::server

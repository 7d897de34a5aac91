// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/tls.h"

#include <gmock/gmock.h>

#include <chrono>
#include <optional>
#include <thread>

#include "kinemark/io/file.h"
#include "server/http_server.h"
#include "server/testing/certificate.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::make_certificate;
using testing::TlsClient;

class TlsFiles : public ::testing::Test {
 protected:
  void put(const testing::Certificate& made) const {
    put("cert.pem", made.certificate);
    put("key.pem", made.key);
  }
  void put(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(io::write_text(scratch_ / name, text, true));
  }
  [[nodiscard]] Result<std::shared_ptr<Tls>> read() const {
    return Tls::read(scratch_ / "cert.pem", scratch_ / "key.pem");
  }
  void expect_wrong(Code code, const std::string& words) const {
    const auto tls = read();
    ASSERT_FALSE(tls);
    EXPECT_EQ(tls.error().code, code);
    EXPECT_THAT(tls.error().message, HasSubstr(words));
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(TlsFiles, TellWhatTheCertificateIsFor) {
  put(make_certificate("DNS:lab-pc,IP:10.0.0.7,DNS:*.lab.example,IP:::1,email:a@b.example"));
  EXPECT_THAT(read().value()->names(), ElementsAre("lab-pc", "10.0.0.7", "[::1]"));
  put(make_certificate(""));
  EXPECT_THAT(read().value()->names(), IsEmpty());
}

TEST_F(TlsFiles, ThatCannotBeReadOrAreNoneAreASentence) {
  put(make_certificate(""));
  put("cert.pem", "-----BEGIN CERTIFICATE-----\nnonsense\n-----END CERTIFICATE-----\n");
  expect_wrong(Code::bad_input, "cert.pem: is no certificate; need one in PEM");
  put(make_certificate(""));
  put("key.pem", "nonsense");
  expect_wrong(Code::bad_input, "key.pem: is no key; need one in PEM");
  std::filesystem::remove(scratch_ / "key.pem");
  expect_wrong(Code::io, "key.pem");
  std::filesystem::remove(scratch_ / "cert.pem");
  expect_wrong(Code::io, "cert.pem");
}

TEST_F(TlsFiles, AKeyOfAnotherCertificateIsRefused) {
  put(make_certificate(""));
  put("key.pem", make_certificate("").key);
  expect_wrong(Code::bad_input, "key.pem: is not the key of the certificate");
}

TEST_F(TlsFiles, AKeyWithAPasswordIsRefusedWithoutAskingForIt) {
  put(make_certificate("", "secret"));
  expect_wrong(Code::bad_input, "key.pem: is encrypted; need a key without a password");
}

TEST_F(TlsFiles, SwappedFilesAreNoCertificate) {
  const auto made = make_certificate("");
  put({.certificate = made.key, .key = made.certificate});
  expect_wrong(Code::bad_input, "cert.pem: is no certificate");
}

/// A server with a certificate that admits everybody.
class TlsThread : public TlsFiles {
 protected:
  void start(const HttpLimits& limits = {}) {
    put(make_certificate("IP:127.0.0.1"));
    server_ = HttpServer::listen("127.0.0.1", 0, limits, read().value()).value();
    thread_ = std::thread([this] {
      server_->run([](const Request& request, const Reply& reply) {
        Response response{.type = "text/plain", .admitted = request.target != "/stranger"};
        response.body = std::make_shared<const std::string>(
            request.target == "/large" ? std::string(8UL << 20, 'x') : request.target);
        reply(std::move(response));
      });
    });
  }
  void TearDown() override {
    if (server_) server_->stop();
    if (thread_.joinable()) thread_.join();
  }
  static std::string get(const std::string& target) {
    return "GET " + target + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  }
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
};

TEST_F(TlsThread, AnswersOverTls12And13AndSaysWhenItEnds) {
  start();
  for (const auto& [version, name] :
       {std::pair(TLS1_2_VERSION, "TLSv1.2"), std::pair(TLS1_3_VERSION, "TLSv1.3")}) {
    const TlsClient client(server_->port(), version);
    ASSERT_TRUE(client.greeted());
    EXPECT_EQ(client.version(), name);
    client.send(get("/hello"));
    const auto [text, said] = client.read_all();
    EXPECT_THAT(text, EndsWith("\r\n\r\n/hello"));
    EXPECT_TRUE(said) << "nothing was cut off";
  }
}

TEST_F(TlsThread, ALargeResponseArrivesWhole) {
  start();
  const TlsClient client(server_->port());
  client.send(get("/large"));
  EXPECT_GT(client.read_all().first.size(), 8UL << 20);
}

TEST_F(TlsThread, OlderVersionsAreRefused) {
  start();
  EXPECT_FALSE(TlsClient(server_->port(), TLS1_1_VERSION).greeted());
  EXPECT_TRUE(TlsClient(server_->port()).greeted()) << "and others still let in";
}

TEST_F(TlsThread, PlainHttpGetsNoAnswer) {
  start();
  const testing::Client client(server_->port());
  client.send(get("/hello"));
  EXPECT_THAT(client.read_all(), ::testing::Not(HasSubstr("hello")));
}

TEST_F(TlsThread, WhoDoesNotFinishTheHandshakeIsSentAway) {
  start({.request = std::chrono::milliseconds(50)});
  const testing::Client client(server_->port());
  client.send(std::string("\x16\x03\x01\x02\x00\x01", 6));  // a handshake of 512 bytes begins
  EXPECT_EQ(client.read_all(), "");
  EXPECT_TRUE(TlsClient(server_->port()).greeted());
}

TEST_F(TlsThread, HandshakesThatNeverEndKeepNobodyOut) {
  start({.strangers = 4});
  std::vector<testing::Client> held;
  for (int i = 0; i < 20; ++i) {
    held.emplace_back(server_->port());
    held.back().send("\x16");
  }
  const TlsClient client(server_->port());
  client.send(get("/hello"));
  EXPECT_THAT(client.read_all().first, EndsWith("/hello"));
}

}  // namespace
}  // namespace kinemark::server

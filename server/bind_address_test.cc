// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/bind_address.h"

#include <gmock/gmock.h>

namespace kinemark::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(BindAddress, OfThisMachineAloneIsTaken) {
  for (const char* address : {"127.0.0.1", "127.0.0.2", "127.255.255.254", "::1", "0:0:0:0:0:0:0:1"})
    EXPECT_TRUE(check_bind_address(address)) << address;
}

TEST(BindAddress, ThatOthersReachIsRefusedWithWhatToDo) {
  for (const char* address : {"0.0.0.0", "192.168.1.7", "10.0.0.1", "128.0.0.1", "126.255.255.255",
                              "::", "fe80::1", "::ffff:127.0.0.1", "::2"}) {
    const auto status = check_bind_address(address);
    ASSERT_FALSE(status) << address;
    EXPECT_EQ(status.error().code, Code::usage);
    EXPECT_THAT(status.error().message, HasSubstr(std::string("--bind: ") + address + " can be reached"));
    EXPECT_THAT(status.error().message, HasSubstr("TLS"));
    EXPECT_THAT(status.error().message, HasSubstr("ssh -L"));
  }
}

TEST(BindAddress, AnyOtherIsTakenWhereThereIsTls) {
  for (const char* address : {"0.0.0.0", "192.168.1.7", "::", "fe80::1", "127.0.0.1"})
    EXPECT_TRUE(check_bind_address(address, true)) << address;
  EXPECT_FALSE(check_bind_address("lab-pc", true));
}

TEST(BindAddress, IsANumberNotAName) {
  using namespace std::string_view_literals;
  for (const auto address : {"localhost"sv, ""sv, "127.1"sv, "127.0.0.1:80"sv, "[::1]"sv, "127.0.0.01x"sv,
                             " ::1"sv, "127.0.0.1\0.evil"sv, "::1%lo"sv}) {
    const auto status = check_bind_address(address);
    ASSERT_FALSE(status) << address;
    EXPECT_THAT(status.error().message, HasSubstr("is not an IP address; need 127.0.0.1 or ::1"));
  }
}

TEST(OwnHosts, AreTheAddressAndLocalhostWithThePort) {
  EXPECT_THAT(own_hosts("127.0.0.1", 8123), ElementsAre("127.0.0.1:8123", "localhost:8123"));
  EXPECT_THAT(own_hosts("::1", 8123), ElementsAre("[::1]:8123", "localhost:8123"));
  EXPECT_THAT(own_hosts("0:0:0:0:0:0:0:1", 1), ElementsAre("[::1]:1", "localhost:1"));
}

TEST(OwnHosts, AnotherLoopbackAddressIsNotLocalhost) {
  EXPECT_THAT(own_hosts("127.0.0.2", 8123), ElementsAre("127.0.0.2:8123"));
}

TEST(OwnHosts, AreFirstTheNamesOfTheCertificate) {
  const std::vector<std::string> names = {"lab-pc", "10.0.0.7"}, none;
  EXPECT_THAT(own_hosts("10.0.0.7", 8123, &names), ElementsAre("lab-pc:8123", "10.0.0.7:8123"));
  EXPECT_THAT(own_hosts("0.0.0.0", 443, &names),
              ElementsAre("lab-pc:443", "10.0.0.7:443", "lab-pc", "10.0.0.7"));
  EXPECT_THAT(own_hosts("fe80::1", 1, &none), ElementsAre("[fe80::1]:1"));
  EXPECT_THAT(own_hosts("127.0.0.1", 80, &none), ElementsAre("127.0.0.1:80", "localhost:80"));
  EXPECT_THAT(own_hosts("::", 1, &none), ::testing::IsEmpty());
  EXPECT_THAT(own_hosts("0.0.0.0", 1, &none), ::testing::IsEmpty());
}

TEST(OwnHosts, Port80MayBeLeftOut) {
  EXPECT_THAT(own_hosts("127.0.0.1", 80),
              ElementsAre("127.0.0.1:80", "localhost:80", "127.0.0.1", "localhost"));
}

}  // namespace
}  // namespace kinemark::server

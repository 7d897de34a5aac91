// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/bind_address.h"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <netinet/in.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "kinemark/core/utf8.h"

namespace kinemark::server {
namespace {

std::optional<in_addr> as_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1 ? std::optional(address) : std::nullopt;
}

std::optional<in6_addr> as_ipv6(const std::string& text) {
  in6_addr address{};
  return ::inet_pton(AF_INET6, text.c_str(), &address) == 1 ? std::optional(address) : std::nullopt;
}

bool is_loopback(const in_addr& address) { return (ntohl(address.s_addr) >> 24U) == 127; }

}  // namespace

Status check_bind_address(std::string_view address, bool has_tls) {
  const std::string text(address);
  const bool has_nul = text.find('\0') != std::string::npos;
  const auto ipv4 = has_nul ? std::nullopt : as_ipv4(text);
  const auto ipv6 = has_nul || ipv4 ? std::nullopt : as_ipv6(text);
  if (!ipv4 && !ipv6)
    return fail(Code::usage,
                fmt::format("--bind: '{}' is not an IP address; need 127.0.0.1 or ::1", printable(text, 60)));
  if (has_tls || (ipv4 ? is_loopback(*ipv4) : IN6_IS_ADDR_LOOPBACK(&*ipv6) != 0)) return {};
  return fail(
      Code::usage,
      fmt::format("--bind: {} can be reached from other machines, which needs TLS: give --certificate "
                  "and --key, or use 127.0.0.1 or ::1, and 'ssh -L' from elsewhere",
                  text));
}

std::vector<std::string> own_hosts(std::string_view address, std::uint16_t port,
                                   const std::vector<std::string>* certificate) {
  const std::string text(address);
  const auto ipv4 = as_ipv4(text);
  const auto ipv6 = ipv4 ? std::nullopt : as_ipv6(text);
  std::vector<std::string> names = certificate != nullptr ? *certificate : std::vector<std::string>();
  const auto add = [&names](std::string name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  };
  const bool is_loopback_6 = ipv6 && IN6_IS_ADDR_LOOPBACK(&*ipv6) != 0;
  const bool is_any = ipv4 ? ipv4->s_addr == INADDR_ANY : ipv6 && IN6_IS_ADDR_UNSPECIFIED(&*ipv6) != 0;
  if (!is_any) add(is_loopback_6 ? "[::1]" : ipv6 ? fmt::format("[{}]", text) : text);
  if (is_loopback_6 || text == "127.0.0.1") add("localhost");
  std::vector<std::string> hosts;
  for (const auto& name : names) hosts.push_back(fmt::format("{}:{}", name, port));
  if (port == (certificate != nullptr ? 443 : 80)) hosts.insert(hosts.end(), names.begin(), names.end());
  return hosts;
}

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/entrance.h"

#include <fmt/core.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

namespace kinemark::server {
namespace {

constexpr std::string_view kTokenQuery = "/?token=";
constexpr std::string_view kBearer = "Bearer ";

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c; });
  return out;
}

/// What reads and changes nothing, whatever its target.
bool only_reads(const Request& request) {
  return (request.method == "GET" || request.method == "HEAD") && !request.upgrade;
}

}  // namespace

Result<std::string> new_secret() {
  std::array<std::uint8_t, 16> bytes{};
  // Up to 256 bytes come whole or not at all (getrandom(2)).
  while (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    if (errno != EINTR)
      return fail(Code::io, fmt::format("the system's random source cannot be read ({})",
                                        std::generic_category().message(errno)));
  std::string digits;
  for (const auto byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

bool same_secret(std::string_view given, std::string_view secret) {
  if (secret.empty()) return false;
  unsigned difference = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |=
        static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(secret[i % secret.size()]);
  return difference == 0;
}

Response sentence_page(int status, std::string_view sentence) {
  return {.status = status,
          .type = "text/plain; charset=utf-8",
          .body = std::make_shared<const std::string>(fmt::format("kinemark: {}\n", sentence))};
}

void add_safe_headers(Response& response) {
  const auto has = [&](std::string_view name) {
    return std::ranges::any_of(response.headers, [&](const auto& header) { return header.first == name; });
  };
  const auto add = [&](const char* name, const char* value) {
    if (!has(name)) response.headers.emplace_back(name, value);
  };
  add("Content-Security-Policy",
      "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  add("Cache-Control", "no-store");
  add("Cross-Origin-Resource-Policy", "same-origin");
  add("Cross-Origin-Opener-Policy", "same-origin");
}

Entrance::Entrance(Keys keys) : keys_(std::move(keys)) {}

bool Entrance::takes_token(std::string_view given) {
  if (same_secret(given, keys_.token)) return true;
  const std::scoped_lock lock(mutex_);
  if (!same_secret(given, keys_.opening)) return false;
  keys_.opening.clear();
  return true;
}

bool Entrance::take_session(Request& request) const {
  if (request.authorization.starts_with(kBearer))
    return same_secret(std::string_view(request.authorization).substr(kBearer.size()), keys_.token);
  const auto end = request.target.find('/', 1);
  if (!request.target.starts_with('/') || end == std::string::npos) return false;
  if (!same_secret(std::string_view(request.target).substr(1, end - 1), keys_.session)) return false;
  request.target.erase(0, end);
  return true;
}

std::optional<Response> Entrance::ask(Request& request) {
  if (!request.host || std::ranges::find(keys_.hosts, lower(*request.host)) == keys_.hosts.end())
    return sentence_page(421, fmt::format("This server is {} and answers to no other name.", keys_.hosts[0]));
  if (!only_reads(request) &&
      (!request.origin ||
       lower(*request.origin) != (keys_.tls ? "https://" : "http://") + lower(*request.host)))
    return sentence_page(403, "This is for pages of this server alone.");
  if (request.method == "GET" && !request.upgrade && request.target.starts_with(kTokenQuery) &&
      takes_token(std::string_view(request.target).substr(kTokenQuery.size()))) {
    Response response{.status = 303, .admitted = true};
    response.headers = {{"Location", keys_.root()}};
    return response;
  }
  if (!take_session(request)) {
    auto response = sentence_page(401, "Open the address that 'kinemark serve' printed; it holds the token.");
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"kinemark\"");
    return response;
  }
  // Whether a target takes POST is said by who answers it.
  const bool posts = request.method == "POST" && !request.upgrade;
  if (!only_reads(request) && request.method != "GET" && !posts) {
    auto response = sentence_page(405, "This server takes GET, HEAD and, for edits, POST.");
    response.headers.emplace_back("Allow", "GET, HEAD, POST");
    return response;
  }
  return std::nullopt;
}

}  // namespace kinemark::server

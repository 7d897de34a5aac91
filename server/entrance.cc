// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/entrance.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "server/secret.h"

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

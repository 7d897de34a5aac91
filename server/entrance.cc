// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/entrance.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/html_text.h"
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

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<std::string_view> cookie_value(std::string_view header, std::string_view name) {
  std::optional<std::string_view> value;
  while (!header.empty()) {
    const auto end = std::min(header.find(';'), header.size());
    const auto pair = trimmed(header.substr(0, end));
    header.remove_prefix(std::min(end + 1, header.size()));
    const auto equals = pair.find('=');
    if (equals == std::string_view::npos || pair.substr(0, equals) != name) continue;
    if (value) return std::nullopt;
    value = pair.substr(equals + 1);
  }
  return value;
}

Response sentence_page(int status, std::string_view sentence) {
  Response response{.status = status};
  response.body = std::make_shared<const std::string>(
      fmt::format("<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>kinemark</title>"
                  "<h1>kinemark</h1><p>{}</p></html>\n",
                  html_text(sentence)));
  return response;
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

bool Entrance::knows_session(const Request& request) const {
  if (request.authorization.starts_with(kBearer))
    return same_secret(std::string_view(request.authorization).substr(kBearer.size()), keys_.token);
  const auto value = cookie_value(request.cookie, keys_.cookie);
  return value && same_secret(*value, keys_.session);
}

std::optional<Response> Entrance::ask(const Request& request) {
  if (!request.host || std::ranges::find(keys_.hosts, lower(*request.host)) == keys_.hosts.end())
    return sentence_page(421, fmt::format("This server is {} and answers to no other name.", keys_.hosts[0]));
  if (!only_reads(request) &&
      (!request.origin ||
       lower(*request.origin) != (keys_.tls ? "https://" : "http://") + lower(*request.host)))
    return sentence_page(403, "This is for pages of this server alone.");
  if (request.method == "GET" && !request.upgrade && request.target.starts_with(kTokenQuery) &&
      takes_token(std::string_view(request.target).substr(kTokenQuery.size()))) {
    Response response{.status = 303, .admitted = true};
    response.headers = {{"Location", "/"},
                        {"Set-Cookie", fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}", keys_.cookie,
                                                   keys_.session, keys_.tls ? "; Secure" : "")}};
    return response;
  }
  if (!knows_session(request)) {
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

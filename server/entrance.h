// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Who is let in. Three things are asked, in this order: that the browser means this server (a foreign name
// that resolves to 127.0.0.1 is a page of others), that what changes something comes from a page of ours, and
// that who asks was shown the address which the program printed.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/message.h"

namespace kinemark::server {

/// What lets in. All secrets are 128 bits of new_secret().
struct Keys {
  std::vector<std::string> hosts;  ///< as own_hosts()
  std::string token;               ///< in the printed URL, for as long as the server runs
  std::string opening;             ///< in the URL of the browser that is opened: once; empty: none
  std::string session;             ///< value of the cookie that a token is exchanged for
  bool tls = false;                ///< browsers come by https, and the cookie is for that alone
  std::string cookie;              ///< name of the cookie; cookies know no port, so it holds the port
};

/// Asks every request. Threads may ask at once.
class Entrance {
 public:
  explicit Entrance(Keys keys);

  /// The refusal (421, 403, 401, 405), or the way from a token to the cookie (303); nothing for who is let
  /// in.
  [[nodiscard]] std::optional<Response> ask(const Request& request);

 private:
  [[nodiscard]] bool takes_token(std::string_view given);
  [[nodiscard]] bool knows_session(const Request& request) const;

  Keys keys_;
  std::mutex mutex_;  ///< of `opening`
};

/// The value of a cookie in a `Cookie` header; nothing where it is absent or there twice.
[[nodiscard]] std::optional<std::string_view> cookie_value(std::string_view header, std::string_view name);

/// A short page with one sentence.
[[nodiscard]] Response sentence_page(int status, std::string_view sentence);

/// Headers of every response: no guessing of types, no caching, nothing to other sites, no foreign frames.
void add_safe_headers(Response& response);

}  // namespace kinemark::server

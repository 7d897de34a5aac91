// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Who is let in. Three things are asked, in this order: that the browser means this server (a foreign name
// that resolves to 127.0.0.1 is a page of others), that what changes something comes from a page of ours, and
// that who asks was shown the address which the program printed. The last is shown by where the pages are:
// all of them lie below a path that nobody else knows. Browsers send cookies to every port of a machine, and
// with them whatever program listens there could read and edit; a path goes to nobody by itself.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "server/message.h"

namespace kinemark::server {

//
// Random words that let in who knows them.

/// 128 bits from the system's random source as 32 lower-case hexadecimal digits. Code::io without one.
[[nodiscard]] Result<std::string> new_secret();

/// Whether both are the same, in a time that depends on the length of `given` alone. Never with an empty
/// secret.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view secret);

/// What lets in. All secrets are 128 bits of new_secret().
struct Keys {
  std::vector<std::string> hosts;  ///< as own_hosts()
  std::string token;               ///< in the printed URL, for as long as the server runs
  std::string opening;             ///< in the URL of the browser that is opened: once; empty: none
  std::string session;             ///< path that a token is exchanged for: pages are at "/SESSION/..."
  bool tls = false;                ///< browsers come by https

  /// Where pages of the browser begin: "/SESSION/".
  [[nodiscard]] std::string root() const { return "/" + session + "/"; }
};

/// Asks every request. Threads may ask at once.
class Entrance {
 public:
  explicit Entrance(Keys keys);

  /// The refusal (421, 403, 401, 405), or the way from a token to the session (303); nothing for who is let
  /// in: `request.target` is then without the session, "/trial/1".
  [[nodiscard]] std::optional<Response> ask(Request& request);

 private:
  [[nodiscard]] bool takes_token(std::string_view given);
  /// Whether who asks knows a secret; the session is taken off the target.
  [[nodiscard]] bool take_session(Request& request) const;

  Keys keys_;
  std::mutex mutex_;  ///< of `opening`
};

/// One sentence as plain text, for whom no page is made.
[[nodiscard]] Response sentence_page(int status, std::string_view sentence);

/// Headers of every response: no guessing of types, no caching, nothing to other sites, no foreign frames.
void add_safe_headers(Response& response);

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/entrance.h"
#include "server/live_feed.h"
#include "server/message.h"
#include "server/trial_page.h"

namespace kinemark::server {

/// A live source in the browser: its page at "/", frames over a WebSocket at "/live/socket", how it goes as
/// JSON at "/api/live". Everything else is 404.
class LiveService {
 public:
  /// @param page  as live_page(); @param nonce  unpredictable, of new_secret()
  LiveService(Keys keys, std::string page, std::string_view nonce, std::unique_ptr<LiveFeed> feed);

  /// Answer a request, at once.
  void handle(Request request, const Reply& reply);

 private:
  [[nodiscard]] Response answer(const Request& request);
  [[nodiscard]] Response open_socket();

  std::string root_;
  Entrance entrance_;
  Page page_;
  std::unique_ptr<LiveFeed> feed_;
};

/// How a source goes, as "/api/live" says it.
[[nodiscard]] std::string live_state_json(const LiveState& state);

}  // namespace kinemark::server

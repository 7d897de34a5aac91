// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "kinemark/pipeline/desk/desk_session.h"
#include "server/entrance.h"
#include "server/message.h"
#include "server/trial_page.h"
#include "server/worker.h"

namespace kinemark::server {

/// A desk, its session, and who ends it.
struct ServedDesk {
  std::unique_ptr<pipeline::Desk> desk;            ///< never nullptr
  std::unique_ptr<pipeline::DeskSession> session;  ///< of that desk; ends before it
  std::function<bool()> stop = nullptr;  ///< asked some ten times a second: to be left; nullptr: never
  std::function<void(const pipeline::DeskState&)> ended = nullptr;  ///< called with the end, on its thread
};

/// Trials of a device in the browser: the page at "/", how the session stands as JSON at "/api/desk" (GET),
/// and what it is asked for there (POST, parse_desk_request()), which is answered with how it stands then;
/// 400 for what is no request, 415 for another type of content, 503 where too much waits. Everything else is
/// 404.
///
/// One thread has the session. It looks at a trial ten times a second, so that one whose time is up ends
/// where no page is open.
class DeskService {
 public:
  /// @param page  as pipeline::desk_page()  @param nonce  unpredictable, of new_secret()
  DeskService(Keys keys, std::string page, std::string_view nonce, ServedDesk served);

  /// Answer a request, at once or from the session's thread.
  void handle(Request request, const Reply& reply);

 private:
  [[nodiscard]] Response show(const Request& request) const;
  [[nodiscard]] Response answer(const Request& request);
  void look();

  std::string root_;
  Entrance entrance_;
  Page page_;
  ServedDesk served_;  ///< of the worker alone
  bool left_ = false;  ///< likewise
  Worker worker_;      ///< ends first
};

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What goes in and out of the server, without a word on sockets.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::server {

class SocketPeer;

/// The parts of an HTTP request that decide something. A header that was sent twice is joined with ", ", and
/// so is never taken for the value of one.
struct Request {
  std::string method;                 ///< "GET"
  std::string target;                 ///< as sent: "/trial/1?x"
  std::optional<std::string> host;    ///< of the header
  std::optional<std::string> origin;  ///< of the header
  std::string authorization;          ///< of the header; empty without
  bool upgrade = false;               ///< asks for a WebSocket
  std::string type;                   ///< of the body, as the header says; empty without
  std::string body;                   ///< as sent; empty without
};

/// An HTTP response; what all of them carry (length, date) is added where it is sent.
struct Response {
  int status = 200;                                          ///< of HTTP
  std::string type = "text/html; charset=utf-8";             ///< of the body
  std::shared_ptr<const std::string> body;                   ///< empty: none
  std::vector<std::pair<std::string, std::string>> headers;  ///< names and values
  bool admitted = false;               ///< who asked knows the secret: the connection is kept
  std::shared_ptr<SocketPeer> socket;  ///< whom a request for a WebSocket gets, in place of all that; or none
};

/// To be called once, from any thread.
using Reply = std::function<void(Response)>;

}  // namespace kinemark::server

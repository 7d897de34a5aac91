// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// RFC 6455 on a socket whose HTTP request was let in. Included by http_server.cc alone: Boost.Beast compiles
// slowly.
#pragma once

#include <boost/beast/http/fields.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <memory>

#include "server/http_server.h"
#include "server/peer_stream.h"
#include "server/socket_peer.h"

namespace kinemark::server {

/// A WebSocket that was accepted. It lives as long as something of its is under way.
class WebSocket {
 public:
  WebSocket() = default;
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  virtual ~WebSocket() = default;
  /// Close at once; what is under way ends with errors.
  virtual void close() = 0;
};

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Answer the request with 101 and let the peer speak. Where the request is no sound upgrade the connection
/// ends. @param gone  called once, when the connection is closed
std::weak_ptr<WebSocket> open_web_socket(PeerStream stream, const UpgradeRequest& request,
                                         std::shared_ptr<SocketPeer> peer, const HttpLimits& limits,
                                         std::function<void()> gone);

}  // namespace kinemark::server

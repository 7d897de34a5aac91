// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// TCP, or TLS over it: one type for what reads and writes. Included by http_server.cc and web_socket.cc
// alone.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <utility>
#include <variant>

#include "server/tls.h"
#ifdef KINEMARK_TLS
#include <boost/beast/ssl.hpp>
#endif

namespace kinemark::server {

/// An AsyncReadStream and AsyncWriteStream, as Boost.Asio has them, for handlers that are called back.
class PeerStream {
 public:
  using Tcp = boost::beast::tcp_stream;
  using next_layer_type = Tcp;
  using executor_type = Tcp::executor_type;

  /// @param tls  nullptr: plain
  PeerStream(boost::asio::ip::tcp::socket socket, [[maybe_unused]] Tls* tls)
      : stream_(Tcp(std::move(socket))) {
#ifdef KINEMARK_TLS
    if (tls != nullptr) {
      Tcp tcp = std::move(std::get<Tcp>(stream_));
      stream_.emplace<Secured>(std::move(tcp), *static_cast<boost::asio::ssl::context*>(tls->context()));
    }
#endif
  }

  [[nodiscard]] executor_type get_executor() { return next_layer().get_executor(); }
  [[nodiscard]] Tcp& next_layer() {
#ifdef KINEMARK_TLS
    if (auto* secured = std::get_if<Secured>(&stream_)) return secured->next_layer();
#endif
    return std::get<Tcp>(stream_);
  }
  [[nodiscard]] const Tcp& next_layer() const { return const_cast<PeerStream*>(this)->next_layer(); }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    std::visit([&](auto& stream) { stream.async_read_some(buffers, std::forward<Handler>(handler)); },
               stream_);
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    std::visit([&](auto& stream) { stream.async_write_some(buffers, std::forward<Handler>(handler)); },
               stream_);
  }

  /// Before anything else is read or written. `handler(error_code)`.
  template <class Handler>
  void async_greet(Handler handler) {
#ifdef KINEMARK_TLS
    if (auto* secured = std::get_if<Secured>(&stream_))
      return secured->async_handshake(boost::asio::ssl::stream_base::server, std::move(handler));
#endif
    handler(boost::system::error_code());
  }
  /// Nothing more is written. `handler()`, when the other side knows or cannot be told.
  template <class Handler>
  void async_end_writing(Handler handler) {
#ifdef KINEMARK_TLS
    if (auto* secured = std::get_if<Secured>(&stream_))
      return secured->async_shutdown(
          [handler = std::move(handler)](boost::system::error_code) { handler(); });
#endif
    boost::system::error_code ignored;
    (void)next_layer().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    handler();
  }

 private:
#ifdef KINEMARK_TLS
  using Secured = boost::beast::ssl_stream<Tcp>;
  std::variant<Tcp, Secured> stream_;
#else
  std::variant<Tcp> stream_;
#endif
};

/// The end of a WebSocket, after its close frames.
inline void teardown(boost::beast::role_type role, PeerStream& stream, boost::system::error_code& error) {
  boost::beast::teardown(role, stream.next_layer(), error);
}
template <class Handler>
void async_teardown(boost::beast::role_type role, PeerStream& stream, Handler&& handler) {
  boost::beast::async_teardown(role, stream.next_layer(), std::forward<Handler>(handler));
}

}  // namespace kinemark::server

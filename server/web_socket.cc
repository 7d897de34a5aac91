// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/web_socket.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <string_view>
#include <utility>

namespace kinemark::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

class BeastSocket final : public WebSocket, public std::enable_shared_from_this<BeastSocket> {
 public:
  BeastSocket(PeerStream stream, std::shared_ptr<SocketPeer> peer, const HttpLimits& limits,
              std::function<void()> gone)
      : stream_(std::move(stream)), limits_(limits), peer_(std::move(peer)), gone_(std::move(gone)) {
    stream_.binary(true);
    stream_.auto_fragment(false);
    stream_.read_message_max(limits.message_bytes);
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(beast::http::field::server, "kinemark");  // without one, Beast names itself
    }));
    set_timeouts(limits.request);
  }
  ~BeastSocket() override { leave(); }

  void accept(const UpgradeRequest& request) {
    stream_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->close();
      self->set_timeouts(self->limits_.farewell);
      self->peer_->opened([weak = std::weak_ptr(self), executor = self->stream_.get_executor()] {
        asio::post(executor, [weak] {
          if (const auto living = weak.lock()) living->speak();
        });
      });
      self->listen();
      self->speak();
    });
  }

  void close() override {
    leave();
    beast::get_lowest_layer(stream_).close();
  }

 private:
  /// @param handshake  of the beginning, then of the end
  void set_timeouts(std::chrono::milliseconds handshake) {
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = handshake, .idle_timeout = limits_.silence, .keep_alive_pings = true});
  }

  void leave() {
    if (left_) return;
    left_ = true;
    peer_->closed();
    if (gone_) std::exchange(gone_, nullptr)();
  }

  void listen() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->close();
      if (self->left_) return;
      const auto bytes = self->buffer_.cdata();
      const std::string_view heard(static_cast<const char*>(bytes.data()), bytes.size());
      if (!self->stream_.got_binary() || !self->peer_->heard(heard))
        return self->end({.code = websocket::close_code::policy_error, .reason = "not understood"});
      self->buffer_.clear();
      self->listen();
      self->speak();
    });
  }

  void speak() {
    if (left_ || ending_ || saying_) return;
    saying_ = peer_->next();
    if (!saying_) {
      if (auto over = peer_->end()) end(*over);
      return;
    }
    stream_.async_write(asio::buffer(*saying_), [self = shared_from_this()](error_code error, std::size_t) {
      self->saying_.reset();
      if (error) return self->close();
      if (self->left_) return;
      self->peer_->sent();
      self->speak();
    });
  }

  void end(const SocketEnd& over) {
    if (left_ || ending_) return;
    ending_ = true;
    // Until the other side says goodbye too, or its time is over, what it still sends is read by this.
    stream_.async_close(websocket::close_reason(static_cast<websocket::close_code>(over.code), over.reason),
                        [self = shared_from_this()](error_code) { self->close(); });
  }

  websocket::stream<PeerStream> stream_;
  HttpLimits limits_;
  std::shared_ptr<SocketPeer> peer_;
  std::function<void()> gone_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> saying_;
  bool ending_ = false, left_ = false;
};

}  // namespace

std::weak_ptr<WebSocket> open_web_socket(PeerStream stream, const UpgradeRequest& request,
                                         std::shared_ptr<SocketPeer> peer, const HttpLimits& limits,
                                         std::function<void()> gone) {
  const auto opened =
      std::make_shared<BeastSocket>(std::move(stream), std::move(peer), limits, std::move(gone));
  opened->accept(request);
  return opened;
}

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/http_server.h"

#include <fmt/core.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <list>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "server/peer_stream.h"
#include "server/web_socket.h"

namespace kinemark::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostFarewellBytes = 1U << 20;
constexpr std::chrono::milliseconds kAcceptPause{50};

class Connection;
using Connections = std::list<Connection*>;

/// All connections, oldest first. Used by the server's thread alone.
struct Books {
  HttpLimits limits;
  Handler handler;
  std::shared_ptr<Tls> tls;
  Connections strangers, waiting, friends;  ///< waiting: for the response to a request that is whole
};

std::string_view view(boost::core::string_view text) { return {text.data(), text.size()}; }

/// A header of a request: several of one name are joined, so that none of them is taken for the only one.
std::optional<std::string> joined(const http::fields& fields, http::field name) {
  std::optional<std::string> value;
  for (auto [at, end] = fields.equal_range(name); at != end; ++at) {
    if (value) value->append(", ");
    if (!value) value.emplace();
    value->append(view(at->value()));
  }
  return value;
}

Request request_of(http::request<http::string_body>&& message) {
  return {
      .method = std::string(view(message.method_string())),
      .target = std::string(view(message.target())),
      .host = joined(message, http::field::host),
      .origin = joined(message, http::field::origin),
      .authorization = joined(message, http::field::authorization).value_or(""),
      .upgrade = beast::websocket::is_upgrade(message) || message.find(http::field::upgrade) != message.end(),
      .type = joined(message, http::field::content_type).value_or(""),
      .body = std::move(message.body())};
}

/// Status for a request that cannot be read; 0: nobody waits for a response.
int status_of(const error_code& error) {
  if (error == http::error::header_limit) return 431;
  if (error == http::error::body_limit) return 413;
  if (error == http::error::end_of_stream || error == http::error::partial_message) return 0;
  return error.category() == http::make_error_code(http::error::bad_method).category() ? 400 : 0;
}

/// One client. It lives as long as something of its is under way, and lies in one of the lists of `books`
/// until it is closed.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Books& books)
      : stream_(std::move(socket), books.tls.get()), books_(books), list_(&books.strangers) {
    at_ = list_->insert(list_->end(), this);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { leave(); }

  /// The handshake, where there is one, and the first request.
  void begin() {
    wire().expires_after(books_.limits.request);
    stream_.async_greet([self = shared_from_this()](error_code error) {
      if (self->list_ == nullptr) return;
      if (error) return self->close();
      self->read();
    });
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(books_.limits.header_bytes);
    parser_->body_limit(books_.limits.body_bytes);
    wire().expires_after(list_ == &books_.friends ? books_.limits.idle : books_.limits.request);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->on_read(error); });
  }

  /// Close at once; what is under way ends with errors.
  void close() {
    leave();
    if (!is_web_socket_) return wire().close();
    if (const auto socket = socket_.lock()) socket->close();
  }

 private:
  [[nodiscard]] beast::tcp_stream& wire() { return stream_.next_layer(); }
  using Whole = http::response<http::span_body<const char>>;
  using HeaderOnly = http::response<http::empty_body>;

  void leave() {
    if (list_ != nullptr) list_->erase(at_);
    list_ = nullptr;
  }

  void move_to(Connections& list) {
    if (list_ == nullptr || list_ == &list) return;
    leave();
    list_ = &list;
    at_ = list.insert(list.end(), this);
  }

  void on_read(const error_code& error) {
    if (list_ == nullptr) return;
    if (error) {
      if (const int status = status_of(error); status != 0) return refuse(status);
      return close();
    }
    auto& message = parser_->get();
    keep_alive_ = message.keep_alive();
    only_header_ = message.method() == http::verb::head;
    if (message.count(http::field::host) > 1) return refuse(400);
    wire().expires_never();
    // Refusals come at once, so who waits here is let in: no crowd of strangers may push it out.
    if (list_ == &books_.strangers) move_to(books_.waiting);
    books_.handler(request_of(std::move(message)), [self = shared_from_this()](Response response) {
      asio::post(self->stream_.get_executor(),
                 [self, response = std::move(response)]() mutable { self->write(std::move(response)); });
    });
  }

  void refuse(int status) {
    keep_alive_ = false;
    write({.status = status, .type = "text/plain; charset=utf-8"});
  }

  void admit() {
    if (list_ == nullptr || list_ == &books_.friends) return;
    while (books_.friends.size() >= books_.limits.friends) books_.friends.front()->close();
    move_to(books_.friends);
  }

  void write(Response response) {
    if (list_ == nullptr) return;
    if (response.admitted)
      admit();
    else
      move_to(books_.strangers);
    if (response.socket) return upgrade(std::move(response.socket));
    keep_alive_ = keep_alive_ && response.admitted;
    body_ = std::move(response.body);
    const std::string_view text = body_ ? std::string_view(*body_) : std::string_view();
    if (only_header_) {
      auto& message = message_.emplace<HeaderOnly>();
      fill(message, response, text.size());
      return send(message);
    }
    auto& message = message_.emplace<Whole>();
    message.body() = {text.data(), text.size()};
    fill(message, response, text.size());
    send(message);
  }

  /// From here on the connection is a WebSocket's, which keeps its place in the books.
  void upgrade(std::shared_ptr<SocketPeer> peer) {
    wire().expires_never();
    is_web_socket_ = true;
    socket_ = open_web_socket(std::move(stream_), parser_->get(), std::move(peer), books_.limits,
                              [self = shared_from_this()] { self->leave(); });
  }

  template <class Message>
  void fill(Message& message, const Response& response, std::size_t bytes) {
    message.version(11);
    message.result(static_cast<unsigned>(response.status));
    for (const auto& [name, value] : response.headers) message.insert(name, value);
    if (bytes > 0) message.set(http::field::content_type, response.type);
    message.set(http::field::content_length, std::to_string(bytes));
    message.keep_alive(keep_alive_);
  }

  template <class Message>
  void send(Message& message) {
    wire().expires_after(books_.limits.response);
    http::async_write(stream_, message,
                      [self = shared_from_this()](error_code error, std::size_t) { self->on_write(error); });
  }

  void on_write(const error_code& error) {
    message_.emplace<std::monostate>();
    body_.reset();
    if (list_ == nullptr) return;
    if (error) return close();
    if (keep_alive_) return read();
    // What comes in still must be taken, or the system drops the response with it.
    wire().expires_after(books_.limits.farewell);
    stream_.async_end_writing([self = shared_from_this()] { self->drain(); });
  }

  void drain() {
    wire().async_read_some(asio::buffer(rest_),
                           [self = shared_from_this()](error_code error, std::size_t bytes) {
                             self->drained_ += bytes;
                             if (error || self->drained_ > kMostFarewellBytes) return self->close();
                             self->drain();
                           });
  }

  PeerStream stream_;
  Books& books_;
  Connections* list_;
  Connections::iterator at_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::variant<std::monostate, Whole, HeaderOnly> message_;
  std::shared_ptr<const std::string> body_;
  std::weak_ptr<WebSocket> socket_;
  std::array<char, 4096> rest_{};
  std::size_t drained_ = 0;
  bool keep_alive_ = false, only_header_ = false, is_web_socket_ = false;
};

class BeastServer final : public HttpServer {
 public:
  BeastServer(const HttpLimits& limits, std::shared_ptr<Tls> tls) {
    books_.limits = limits;
    books_.tls = std::move(tls);
  }

  [[nodiscard]] error_code open(const tcp::endpoint& endpoint) {
    error_code error;
    (void)acceptor_.open(endpoint.protocol(), error);
    if (!error) (void)acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
#ifdef __linux__
    // A connection comes to us with its request: those that only hold one stay with the system for a second.
    const int seconds = 1;
    if (!error)
      (void)::setsockopt(acceptor_.native_handle(), IPPROTO_TCP, TCP_DEFER_ACCEPT, &seconds, sizeof(seconds));
#endif
    if (!error) (void)acceptor_.bind(endpoint, error);
    if (!error) (void)acceptor_.listen(asio::socket_base::max_listen_connections, error);
    return error;
  }

  [[nodiscard]] std::uint16_t port() const override { return acceptor_.local_endpoint().port(); }

  void run(Handler handler) override {
    books_.handler = std::move(handler);
    accept();
    context_.run();
  }

  void stop() override { context_.stop(); }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // most likely out of descriptors, of which connections that end give some back
        pause_.expires_after(kAcceptPause);
        pause_.async_wait([this](error_code) { accept(); });
        return;
      }
      error_code ignored;
      (void)socket.set_option(tcp::no_delay(true), ignored);
      while (books_.strangers.size() >= books_.limits.strangers) books_.strangers.front()->close();
      std::make_shared<Connection>(std::move(socket), books_)->begin();
      accept();
    });
  }

  Books books_;  ///< outlives the context, which destroys connections
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer pause_{context_};
};

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::listen(const std::string& address, std::uint16_t port,
                                                       const HttpLimits& limits, std::shared_ptr<Tls> tls) {
  error_code error;
  const auto numeric = asio::ip::make_address(address, error);
  auto server = std::make_unique<BeastServer>(limits, std::move(tls));
  if (!error) error = server->open({numeric, port});
  if (error)
    return fail(Code::io,
                fmt::format("{} port {}: cannot be listened on ({}); --port 0 takes any that is free",
                            address, port, error.message()));
  return server;
}

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// HTTP/1.1 on one port: sockets, limits and timeouts. Who may ask what is not its matter. Its source and
// web_socket.cc are those that include Boost.Beast.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "kinemark/core/result.h"
#include "server/message.h"
#include "server/tls.h"

namespace kinemark::server {

/// What one client can take from others. A connection is a stranger's until a response to it was
/// `admitted`. Where there are too many, the oldest goes: who asks at once is answered, who only holds
/// connections loses them.
struct HttpLimits {
  std::uint32_t header_bytes = 16'384;         ///< of a request: beyond, 431
  std::uint32_t body_bytes = 4'096;            ///< of a request: beyond, 413
  std::size_t strangers = 256;                 ///< connections
  std::size_t friends = 64;                    ///< connections that were admitted
  std::chrono::milliseconds request{5'000};    ///< for all of a request to arrive, and for a TLS handshake
  std::chrono::milliseconds idle{60'000};      ///< for the next one to arrive, of who is admitted
  std::chrono::milliseconds response{60'000};  ///< for a response to be taken
  std::chrono::milliseconds farewell{
      1'000};                      ///< for the end of a connection that was refused, or of a WebSocket
  std::size_t message_bytes = 64;  ///< of what comes over a WebSocket: beyond, it ends (1009)
  std::chrono::milliseconds silence{30'000};  ///< of a WebSocket whose other side answers no ping
};

/// Called for each request, on the server's thread: must return soon.
using Handler = std::function<void(const Request&, Reply)>;

/// A port that is listened on. One thread runs it.
class HttpServer {
 public:
  /// Listen. Code::io, in one sentence, where the address or port cannot be had.
  /// @param address  numeric
  /// @param port     0: any that is free
  /// @param tls      certificate and key; nullptr: plain HTTP
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> listen(const std::string& address,
                                                                  std::uint16_t port,
                                                                  const HttpLimits& limits = {},
                                                                  std::shared_ptr<Tls> tls = nullptr);
  virtual ~HttpServer() = default;

  [[nodiscard]] virtual std::uint16_t port() const = 0;  ///< the one that is listened on
  /// Answer until stop(). To be called once. Replies may come from any thread as long as the server lives.
  virtual void run(Handler handler) = 0;
  /// Make run() return. From any thread.
  virtual void stop() = 0;
};

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What goes over a WebSocket, without a word on sockets.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kinemark::server {

/// Why a WebSocket ends, as its close frame says.
struct SocketEnd {
  std::uint16_t code = 1000;  ///< of RFC 6455: 1000 done, 1008 what was said is not understood
  std::string reason;         ///< one sentence of at most 120 bytes
};

/// The program's side of one WebSocket. Called on the server's thread.
class SocketPeer {
 public:
  virtual ~SocketPeer() = default;

  /// The connection is there. `wake` has next() asked again; it may be called from any thread until closed().
  virtual void opened(std::function<void()> wake) = 0;
  /// The next binary message to be sent, once the one before is with the system; nothing: not now.
  [[nodiscard]] virtual std::shared_ptr<const std::string> next() = 0;
  /// The message that next() gave last is with the system.
  virtual void sent() = 0;
  /// Asked when there is no next message: whether the connection is to end.
  [[nodiscard]] virtual std::optional<SocketEnd> end() = 0;
  /// A binary message came; false: it is not understood, and the connection ends.
  [[nodiscard]] virtual bool heard(std::string_view bytes) = 0;
  /// The connection is gone, or never came to be. Called once, and nothing after it.
  virtual void closed() = 0;
};

}  // namespace kinemark::server

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/testing/client.h"

namespace kinemark::server::testing {

/// A frame of a WebSocket: what it is (2 binary, 8 close, 9 ping, 10 pong; 0 none came) and its bytes.
struct WebFrame {
  int kind = 0;
  std::string bytes;
  /// The code of a close frame.
  [[nodiscard]] int code() const {
    return bytes.size() < 2
               ? 0
               : 256 * static_cast<unsigned char>(bytes[0]) + static_cast<unsigned char>(bytes[1]);
  }
};

/// Headers of a request for a WebSocket, as RFC 6455 has them in its example.
inline const std::string kUpgradeHeaders =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

/// The client's side of a WebSocket.
class WebClient : public Client {
 public:
  using Client::Client;

  /// Ask for one; the head of the answer.
  [[nodiscard]] std::string open(const std::string& target,
                                 const std::string& headers = kUpgradeHeaders) const {
    send("GET " + target + " HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n");
    std::string head;
    while (!head.ends_with("\r\n\r\n")) {
      const auto letter = read_bytes(1);
      if (letter.empty()) break;
      head += letter;
    }
    return head;
  }

  /// A frame that ends its message, masked as clients must; `mask` false: not masked.
  void say(int kind, std::string_view bytes, bool mask = true) const {
    constexpr std::string_view kMask = "mask";
    std::string frame{static_cast<char>(0x80 | kind)};
    const int flag = mask ? 0x80 : 0;
    if (bytes.size() < 126) {
      frame += static_cast<char>(flag | static_cast<int>(bytes.size()));
    } else {
      frame += static_cast<char>(flag | 127);
      for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>(bytes.size() >> shift & 0xFFU);
    }
    if (mask) frame += kMask;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      frame += static_cast<char>(mask ? bytes[i] ^ kMask[i % kMask.size()] : bytes[i]);
    send(frame);
  }

  /// The next frame of the server.
  [[nodiscard]] WebFrame hear() const {
    const auto head = read_bytes(2);
    if (head.size() < 2) return {};
    std::size_t size = static_cast<unsigned char>(head[1]);
    if (size >= 126) {
      const auto more = read_bytes(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : more) size = 256 * size + static_cast<unsigned char>(c);
    }
    return {.kind = head[0] & 0x0F, .bytes = read_bytes(size)};
  }
};

}  // namespace kinemark::server::testing

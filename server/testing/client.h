// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace kinemark::server::testing {

/// A client's socket.
class Client {
 public:
  explicit Client(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    const timeval patience{.tv_sec = 60, .tv_usec = 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  }
  Client(Client&& other) noexcept : fd_(std::exchange(other.fd_, -1)), connected_(other.connected_) {}
  Client& operator=(Client&&) = delete;
  ~Client() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] int fd() const { return fd_; }  ///< stays this object's
  void send(const std::string& text) const { (void)::send(fd_, text.data(), text.size(), MSG_NOSIGNAL); }
  void end_sending() const { ::shutdown(fd_, SHUT_WR); }
  /// All until the server closes the connection.
  [[nodiscard]] std::string read_all() const {
    std::string text;
    while (read_some(text)) continue;
    return text;
  }
  /// A response whose length is told, without closing.
  [[nodiscard]] std::string read_one() const {
    std::string text;
    while (text.find("\r\n\r\n") == std::string::npos)
      if (!read_some(text)) return text;
    const auto body = text.find("\r\n\r\n") + 4;
    const auto at = text.find("Content-Length: ");
    const auto length = at == std::string::npos ? 0 : std::stoul(text.substr(at + 16));
    while (text.size() < body + length)
      if (!read_some(text)) return text;
    return text;
  }
  /// So many bytes, or those there are before the server closes.
  [[nodiscard]] std::string read_bytes(std::size_t count) const {
    std::string text(count, '\0');
    std::size_t done = 0;
    while (done < count) {
      const auto n = ::recv(fd_, text.data() + done, count - done, 0);
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    text.resize(done);
    return text;
  }

 private:
  bool read_some(std::string& text) const {
    std::array<char, 4096> buffer{};
    const auto n = ::recv(fd_, buffer.data(), buffer.size(), 0);
    if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
    return n > 0;
  }
  int fd_;
  bool connected_ = false;
};

}  // namespace kinemark::server::testing

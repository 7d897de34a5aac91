// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/serial_port.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "kinemark/stream/internal/device_file.h"

namespace kinemark::stream {
namespace {

constexpr int kWriteMs = 1000;

/// Raw bytes at 500,000 baud. The control line stays up when the program ends: boards restart when it falls.
bool set_raw(int fd, termios line) {
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CSTOPB | CRTSCTS);
  line.c_cc[VMIN] = 0;
  line.c_cc[VTIME] = 0;
  cfsetispeed(&line, B500000);
  cfsetospeed(&line, B500000);
  return tcsetattr(fd, TCSANOW, &line) == 0;
}

int poll_one(int fd, short events, std::chrono::milliseconds timeout, short& found) {
  pollfd one{.fd = fd, .events = events, .revents = 0};
  const int ready = poll(&one, 1, static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, 3'600'000)));
  found = one.revents;
  return ready;
}

}  // namespace

SerialPort::SerialPort(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
SerialPort::SerialPort(SerialPort&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      before_(other.before_),
      is_alone_(other.is_alone_),
      path_(std::move(other.path_)) {}
SerialPort& SerialPort::operator=(SerialPort&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(before_, other.before_);
  std::swap(is_alone_, other.is_alone_);
  std::swap(path_, other.path_);
  return *this;
}
SerialPort::~SerialPort() {
  if (fd_ < 0) return;
  if (before_) tcsetattr(fd_, TCSANOW, &*before_);
  if (is_alone_) ioctl(fd_, TIOCNXCL);
  close(fd_);
}

Result<SerialPort> SerialPort::open(const std::string& path) {
  SerialPort out(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), path);
  if (out.fd_ < 0) return fail(Code::device, cannot_open(path, errno));
  if (isatty(out.fd_) == 0) return fail(Code::device, fmt::format("{}: is no serial line", path));
  // The lock is for programs that ask, the other for those that do not.
  if (flock(out.fd_, LOCK_EX | LOCK_NB) != 0) return fail(Code::device, cannot_open(path, errno));
  termios before{};
  if (tcgetattr(out.fd_, &before) == 0) out.before_ = before;
  out.is_alone_ = ioctl(out.fd_, TIOCEXCL) == 0;
  if (!out.before_ || !set_raw(out.fd_, before))
    return fail(Code::device,
                fmt::format("{}: cannot be set to 500,000 baud: {}", path, std::strerror(errno)));
  out.discard();
  return out;
}

std::unexpected<Error> SerialPort::unplugged() const {
  return fail(Code::device, fmt::format("{}: the rig is gone; plug it in again", path_));
}

Result<std::size_t> SerialPort::read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout) {
  short found = 0;
  const int ready = poll_one(fd_, POLLIN, timeout, found);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return 0;
  if (ready < 0) return unplugged();
  const auto got = ::read(fd_, into.data(), into.size());
  if (got > 0) return static_cast<std::size_t>(got);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return unplugged();
}

Status SerialPort::write(std::string_view text) const {
  while (!text.empty()) {
    short found = 0;
    const int ready = poll_one(fd_, POLLOUT, std::chrono::milliseconds(kWriteMs), found);
    if (ready == 0)
      return fail(Code::device,
                  fmt::format("{}: takes no commands; pull the plug and put it in again", path_));
    const auto sent = ready < 0 ? -1 : ::write(fd_, text.data(), text.size());
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (sent < 0) return unplugged();
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return {};
}

void SerialPort::discard() const { tcflush(fd_, TCIFLUSH); }

}  // namespace kinemark::stream

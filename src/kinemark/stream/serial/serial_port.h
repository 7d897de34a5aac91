// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A serial line of this machine, held by this program alone.
#pragma once

#include <termios.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::stream {

/// An open line at 500,000 baud, 8 bits, no parity, as raw bytes; set as it was before once it closes, and
/// free for others. Failures have Code::device and name the path.
class SerialPort {
 public:
  /// Fails with what to do: absent, no permission (which group to join), in use (by whom), no serial line.
  /// What was received before is forgotten.
  static Result<SerialPort> open(const std::string& path);
  SerialPort(SerialPort&& other) noexcept;
  SerialPort& operator=(SerialPort&& other) noexcept;
  ~SerialPort();

  /// What has come, at least one byte, or 0 when none came in time. Fails when the plug was pulled.
  [[nodiscard]] Result<std::size_t> read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout);
  /// All of it, within a second; by any thread.
  [[nodiscard]] Status write(std::string_view text) const;
  /// The line stays as it is set when it closes: what was written last has to leave at this speed, and boards
  /// restart when the control line falls.
  void keep_setting() { before_.reset(); }
  /// Forget what came and was not read.
  void discard() const;
  [[nodiscard]] const std::string& path() const { return path_; }  ///< as it was opened

 private:
  SerialPort(int fd, std::string path);
  [[nodiscard]] std::unexpected<Error> unplugged() const;
  int fd_ = -1;
  std::optional<termios> before_;  ///< as it was found
  bool is_alone_ = false;          ///< others are kept out; not so of a line that another has
  std::string path_;
};

}  // namespace kinemark::stream

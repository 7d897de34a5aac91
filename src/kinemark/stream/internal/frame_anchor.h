// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which number a device's frames go on with after a break, by the host's clock.
#pragma once

#include <cstdint>

namespace kinemark::stream {

/// The last frame whose time is known. Frames tell the time where they are read as they come; those that
/// waited in a buffer, behind a reader that stalled, do not. So a break is as long as the host says, and a
/// drift of the device's clock before it does not count.
class FrameAnchor {
 public:
  /// @param rate_hz  nominal, > 0
  explicit FrameAnchor(double rate_hz) : rate_hz_(rate_hz) {}
  /// Frame `number` begins at that time.
  void begin(std::int64_t number, std::int64_t host_ns);
  /// All frames before `number` had ended at that time, when they were read.
  void came(std::int64_t number, std::int64_t host_ns);
  /// Number of a frame that begins at that time, where `next` was expected and is lost: at least next + 1.
  [[nodiscard]] std::int64_t after_break(std::int64_t next, std::int64_t host_ns) const;

 private:
  [[nodiscard]] double passed_s(std::int64_t host_ns) const {
    return 1e-9 * static_cast<double>(host_ns - host_ns_);
  }
  double rate_hz_;
  bool begun_ = false;
  std::int64_t number_ = 0, host_ns_ = 0;
};

}  // namespace kinemark::stream

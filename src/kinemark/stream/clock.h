// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinemark::stream {

/// The clock by which blocks are said to have come; tests bring their own. From any thread.
class HostClock {
 public:
  virtual ~HostClock() = default;
  HostClock(const HostClock&) = delete;
  HostClock& operator=(const HostClock&) = delete;
  /// ns since some instant; never runs back, and knows nothing of the time of day.
  [[nodiscard]] virtual std::int64_t now_ns() const = 0;
  /// Return at that time or a little later; at once where it is over.
  virtual void sleep_until(std::int64_t time_ns) = 0;

 protected:
  HostClock() = default;
};

/// The machine's steady clock.
class SteadyHostClock final : public HostClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const override;
  void sleep_until(std::int64_t time_ns) override;
};

}  // namespace kinemark::stream

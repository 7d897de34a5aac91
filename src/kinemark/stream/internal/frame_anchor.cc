// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/internal/frame_anchor.h"

#include <algorithm>
#include <cmath>

namespace kinemark::stream {
namespace {

constexpr double kDelay_s = 0.02;  ///< of a line that is read as frames come
constexpr double kDrift = 0.01;    ///< most of a device's clock: ceramic resonators have half of it

}  // namespace

void FrameAnchor::begin(std::int64_t number, std::int64_t host_ns) {
  begun_ = true;
  number_ = number;
  host_ns_ = host_ns;
}

void FrameAnchor::came(std::int64_t number, std::int64_t host_ns) {
  const double since_s = passed_s(host_ns),
               late_s = since_s - static_cast<double>(number - number_) / rate_hz_;
  if (!begun_ || late_s <= 1.0 / rate_hz_ + kDelay_s + kDrift * since_s) begin(number, host_ns);
}

std::int64_t FrameAnchor::after_break(std::int64_t next, std::int64_t host_ns) const {
  const auto by_clock = begun_ ? number_ + std::llround(passed_s(host_ns) * rate_hz_) : 0;
  return std::max(next + 1, static_cast<std::int64_t>(by_clock));
}

}  // namespace kinemark::stream

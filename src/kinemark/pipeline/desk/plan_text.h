// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A set-up as it is typed.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// What is known before the first screen, and what was typed since.
struct Wanted {
  std::string source;        ///< to open at once; empty: ask
  std::string leds;          ///< a count, or names with commas; empty: all that the device has
  std::string rate_hz;       ///< empty: the highest
  std::string duration_s;    ///< of a trial; empty: until it is stopped
  std::string subject;       ///< may be empty
  std::string trial = "01";  ///< name of the first trial; later ones count on
};

/// A set-up in numbers.
struct Plan {
  stream::ScanPlan scan;    ///< cameras of the device, slots by usual_timing()
  double duration_s = 0.0;  ///< 0: until it is stopped
};

/// The set-up of a device. Code::usage for a line that makes no sense, named.
[[nodiscard]] Result<Plan> plan_of(const Wanted& wanted, const stream::DeviceCapabilities& device);

}  // namespace kinemark::pipeline

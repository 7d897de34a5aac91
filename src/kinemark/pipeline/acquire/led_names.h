// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// LEDs as typed: a count from 1, which takes the device's own names, or names with commas; empty: all that
/// it has. Code::usage for others.
[[nodiscard]] Result<std::vector<std::string>> parse_leds(const std::string& text,
                                                          const stream::DeviceCapabilities& device);

}  // namespace kinemark::pipeline

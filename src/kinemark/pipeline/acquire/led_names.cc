// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/led_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kinemark/core/number.h"

namespace kinemark::pipeline {
namespace {

constexpr int kMost = 64;  // LEDs of a device that does not say how many it has

}  // namespace

Result<std::vector<std::string>> parse_leds(const std::string& text,
                                            const stream::DeviceCapabilities& device) {
  if (trim(text).empty()) return stream::own_names(device.leds, std::max(device.most_leds, 1), false);
  if (const auto count = parse_number(text)) {
    if (*count < 1 || *count > kMost || *count != std::floor(*count))
      return fail(Code::usage, fmt::format("LEDs: '{}' is no whole number from 1 to {}", text, kMost));
    if (device.most_leds > 0 && *count > device.most_leds)
      return fail(Code::usage,
                  fmt::format("LEDs: {} were asked for; the device has {}", text, device.most_leds));
    return stream::own_names(device.leds, static_cast<int>(*count), false);
  }
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.emplace_back(trim(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) return fail(Code::usage, fmt::format("LEDs: a name is missing in '{}'", text));
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      return fail(Code::usage, fmt::format("LEDs: '{}' is named twice", names[i]));
  }
  return names;
}

}  // namespace kinemark::pipeline

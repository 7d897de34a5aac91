// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/device.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace kinemark::stream {

std::vector<std::string> own_names(const std::vector<std::string>& given, int count, bool cameras) {
  std::vector<std::string> out;
  for (int i = 0; i < count; ++i) {
    if (i < static_cast<int>(given.size()))
      out.push_back(given[static_cast<std::size_t>(i)]);
    else
      out.push_back(cameras && i < 26 ? std::string(1, static_cast<char>('A' + i))
                                      : fmt::format("{}", i + 1));
  }
  return out;
}

ScanPlan with_names(ScanPlan plan, const DeviceCapabilities& device) {
  if (plan.leds.empty()) plan.leds = own_names(device.leds, std::max(device.most_leds, 1), false);
  if (plan.cameras.empty()) plan.cameras = own_names(device.camera_names, device.cameras, true);
  return plan;
}

data::SlotTiming usual_timing(const DeviceCapabilities& device) {
  data::SlotTiming out;
  out.settle_s = std::max(out.settle_s, device.fastest.settle_s);
  out.conversion_s = std::max(out.conversion_s, device.fastest.conversion_s);
  out.off_s = std::max(out.off_s, device.fastest.off_s);
  out.dark_slot = device.fastest.dark_slot;
  return out;
}

}  // namespace kinemark::stream

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_schedule.h"

#include <algorithm>

#include "kinemark/core/check.h"

namespace kinemark::studies {

std::vector<LedSlot> schedule_of(const data::Counts& counts, const data::SlotTiming& timing) {
  check(counts.camera_count() > 0, "a schedule has cameras");
  std::vector<LedSlot> out;
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    LedSlot slot{.led = counts.leds[static_cast<std::size_t>(led)], .conversion_s = {}};
    for (std::int64_t camera = 0; camera < counts.camera_count(); ++camera)
      for (const double at : counts.offset_s(led, camera)) slot.conversion_s.push_back(at);
    slot.on_s = std::ranges::min(slot.conversion_s) - timing.settle_s;
    slot.off_s = std::ranges::max(slot.conversion_s) + timing.conversion_s;
    out.push_back(std::move(slot));
  }
  return out;
}

PulseTrain pulse_train(const std::vector<std::pair<double, double>>& pulses, double begin, double end) {
  std::vector<double> time{begin}, level{0.0};
  const auto step = [&](double at, double from, double to) {
    time.insert(time.end(), {at, at});
    level.insert(level.end(), {from, to});
  };
  for (const auto& [on, off] : pulses) {
    if (on < begin || on >= end) continue;
    step(on, 0.0, 1.0);
    if (off <= end) step(off, 1.0, 0.0);
  }
  time.push_back(end);
  level.push_back(level.back());
  const auto n = static_cast<Eigen::Index>(time.size());
  return {Eigen::Map<const Eigen::VectorXd>(time.data(), n),
          Eigen::Map<const Eigen::VectorXd>(level.data(), n)};
}

}  // namespace kinemark::studies

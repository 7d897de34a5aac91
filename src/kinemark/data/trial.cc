// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace kinemark::data {

Status Trial::validate() const {
  if (auto status = markers.validate(); !status) return status;
  if (auto status = channels.validate(); !status) return status;
  if (channels.count() > 0 && channels.frames != markers.frames())
    return fail(Code::bad_input, fmt::format("trial holds channels of {} frames and markers of {}",
                                             channels.frames, markers.frames()));
  const auto samples = static_cast<std::size_t>(markers.frames() * markers.markers());
  if (!residual_m.empty() && residual_m.size() != samples)
    return fail(Code::bad_input,
                fmt::format("trial holds {} residuals; need {} or none", residual_m.size(), samples));
  if (!camera_mask.empty() && camera_mask.size() != samples)
    return fail(Code::bad_input,
                fmt::format("trial holds {} camera masks; need {} or none", camera_mask.size(), samples));
  if (analog.values.size() != static_cast<std::size_t>(analog.samples) * analog.names.size())
    return fail(Code::bad_input, fmt::format("trial holds {} analog values; need {} samples of {} channels",
                                             analog.values.size(), analog.samples, analog.names.size()));
  if (!analog.units.empty() && analog.units.size() != analog.names.size())
    return fail(Code::bad_input, fmt::format("trial names {} analog units for {} channels",
                                             analog.units.size(), analog.names.size()));
  for (const ForcePlate& plate : force_plates) {
    for (const int channel : plate.channel_idx)
      if (channel < 0 || channel >= static_cast<int>(analog.names.size()))
        return fail(Code::bad_input, fmt::format("a force plate uses analog channel {}; the file has {}",
                                                 channel + 1, analog.names.size()));
    const auto& polynomial = plate.pressure_correction;
    if (!polynomial.empty() && !(polynomial.size() == 12 &&
                                 std::ranges::all_of(polynomial, [](double v) { return std::isfinite(v); })))
      return fail(Code::bad_input,
                  fmt::format("force plate {} corrects its centre of pressure by {} numbers; need 12 that "
                              "are finite, or none",
                              plate.number, polynomial.size()));
  }
  if (!std::isfinite(unloaded_s[0]) || !std::isfinite(unloaded_s[1]))
    return fail(Code::bad_input,
                fmt::format("trial has its plates unloaded from {} to {} s", unloaded_s[0], unloaded_s[1]));
  return {};
}

std::optional<std::array<std::int64_t, 2>> unloaded_frames(const Trial& trial) {
  const auto [first_s, last_s] = trial.unloaded_s;
  const auto& time = trial.markers.time;
  if (!(first_s <= last_s) || !(first_s > time.t0_s - 0.5 / time.rate_hz) ||
      !(last_s < time.time_s(time.frames - 1) + 0.5 / time.rate_hz))
    return std::nullopt;
  return std::array{time.nearest_frame(first_s), time.nearest_frame(last_s)};
}

}  // namespace kinemark::data

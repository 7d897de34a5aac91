// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"

namespace kinemark::trajectory::testing {

/// All bytes of what a trial holds, for comparing two: names, times, every array, events.
inline std::string bytes_of(const data::Trial& trial) {
  std::string out;
  const auto number = [&](double v) {
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    out.append(bytes, sizeof v);
  };
  const auto array = [&](const auto& values) {
    number(static_cast<double>(values.size()));
    for (const auto v : values) number(std::isnan(static_cast<double>(v)) ? 1e300 : static_cast<double>(v));
  };
  const auto text = [&](const std::string& t) { out += t + '\0'; };
  const auto& m = trial.markers;
  for (const auto& name : m.names) text(name);
  number(static_cast<double>(trial.first_frame)), number(m.time.t0_s),
      number(static_cast<double>(m.frames()));
  array(m.x_in_world), array(m.covariance), array(m.sample_offset_s), array(m.method);
  array(m.unfiltered_in_world);
  for (const auto& filter : m.filters) text(filter.method), number(filter.cutoff_hz);
  for (const auto& method : m.methods) text(method);
  for (const auto state : m.state) out += static_cast<char>('0' + static_cast<int>(state));
  array(trial.residual_m), array(trial.camera_mask), array(trial.analog.values), array(trial.channels.values);
  for (const auto& event : trial.events) text(event.label), text(event.context), number(event.time_s);
  return out;
}

/// The same with regions.
inline std::string bytes_of(const EditedTrial& edited) {
  auto out = bytes_of(edited.trial);
  for (const auto& r : edited.regions)
    out += r.name + ' ' + std::to_string(r.first_frame) + ' ' + std::to_string(r.last_frame) + '\n';
  return out;
}

/// Two seconds at 100 Hz, frames 501 to 700, of six markers of one turning body with gaps, and two events.
inline data::Trial moving_trial() {
  constexpr std::int64_t kFrames = 200, kMarkers = 6;
  data::Trial trial;
  trial.first_frame = 501;
  trial.markers = data::Trajectories::all_missing({"S:LASI", "S:RASI", "S:SACR", "LKNE", "RKNE", "*12"},
                                                  {.rate_hz = 100.0, .t0_s = 5.0, .frames = kFrames});
  trial.residual_m.assign(kFrames * kMarkers, static_cast<float>(kNaN));
  trial.camera_mask.assign(kFrames * kMarkers, 0);
  trial.markers.unfiltered_in_world.assign(3 * kFrames * kMarkers, kNaN);
  for (std::int64_t m = 0; m < kMarkers; ++m)
    trial.markers.filters.push_back(
        {.method = "kalman", .order = 4, .cutoff_hz = 6.0 + static_cast<double>(m)});
  for (std::int64_t m = 0; m < kMarkers; ++m)
    trial.markers.sample_offset_s.push_back(1e-4 * static_cast<double>(m));
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < kMarkers; ++m) {
      const bool hidden =
          (m == 3 && f >= 40 && f < 60) || (m == 1 && f >= 150 && f < 155) || (m == 5 && f < 100);
      if (hidden) continue;
      const double angle = 0.03 * static_cast<double>(f), at = static_cast<double>(m);
      trial.markers.x(f, m) =
          Eigen::Vector3d(0.1 * at * std::cos(angle) - 0.2 * std::sin(angle),
                          0.1 * at * std::sin(angle) + 0.2 * std::cos(angle), 0.5 + 0.05 * at * at);
      const auto i = trial.markers.index(f, m);
      trial.markers.state[i] = data::SampleState::measured;
      for (std::size_t k = 0; k < 3; ++k)
        trial.markers.unfiltered_in_world[3 * i + k] = trial.markers.x_in_world[3 * i + k] + 1e-3;
      trial.residual_m[i] = static_cast<float>(1e-4 * (at + 1.0));
      trial.camera_mask[i] = static_cast<std::uint8_t>(1 + m);
    }
  trial.events = {{.label = "Foot Strike", .context = "Left", .time_s = 5.4},
                  {.label = "Foot Off", .context = "Right", .time_s = 6.2}};
  return trial;
}

/// An edit that may or may not apply, of markers, frames and events of moving_trial().
inline data::Edit random_edit(Random& random) {
  using data::EditKind;
  const std::vector<std::string> names{"LASI", "S:RASI", "SACR", "LKNE", "RKNE", "*12", "NEW", "S:LASI"};
  const std::vector<std::string> methods{"", "linear", "cubic", "pchip", "rigid"};
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
  };
  data::Edit edit{.kind = static_cast<EditKind>(below(10))};
  edit.marker = names[below(names.size())];
  edit.other = names[below(names.size())];
  edit.method = methods[below(methods.size())];
  const auto first = 495 + static_cast<std::int64_t>(below(210));
  if (random.uniform() < 0.8) edit.first_frame = first;
  if (random.uniform() < 0.8) edit.last_frame = first + static_cast<std::int64_t>(below(40));
  if (edit.kind == EditKind::crop) {
    edit.first_frame = 501 + static_cast<std::int64_t>(below(15));
    edit.last_frame = 700 - static_cast<std::int64_t>(below(15));
  }
  const bool strike = random.uniform() < 0.5;
  edit.label = strike ? "Foot Strike" : "Foot Off";
  edit.context = strike ? "Left" : "Right";
  edit.time_s = random.uniform() < 0.5 ? (strike ? 5.4 : 6.2) : 5.0 + 0.01 * static_cast<double>(below(200));
  edit.to_s = 5.0 + 0.01 * static_cast<double>(below(200));
  edit.name = strike ? "gait" : "turn";
  return edit;
}

}  // namespace kinemark::trajectory::testing

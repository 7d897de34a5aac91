// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/missing.h"
#include "kinemark/data/trial.h"

namespace kinemark::trajectory::testing {

/// Ten frames, numbers 101 to 110 at 100 Hz, of markers A, B and C and the channels "angle" and "moment";
/// every number tells its place, some samples are missing or were made.
inline data::Trial numbered_trial() {
  constexpr std::int64_t kFrames = 10, kMarkers = 3, kChannels = 2, kAnalog = 2, kPerFrame = 5;
  data::Trial trial;
  trial.first_frame = 101;
  auto& markers = trial.markers;
  markers =
      data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 100.0, .t0_s = 1.0, .frames = kFrames});
  for (const double cutoff_hz : {6.0, 7.0, 8.0})
    markers.filters.push_back({.method = "kalman", .order = 4, .cutoff_hz = cutoff_hz});
  double count = 0.0;
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < kMarkers; ++m) {
      trial.residual_m.push_back(static_cast<float>(++count));
      trial.camera_mask.push_back(static_cast<std::uint8_t>(10 * f + m));
      markers.sample_offset_s.push_back(1e-4 * count);
      for (int i = 0; i < 6; ++i) markers.covariance.push_back(count + 0.1 * i);
      for (int i = 0; i < 3; ++i) markers.unfiltered_in_world.push_back(count + 0.01 * i);
      if (f % 4 == m) continue;
      markers.x(f, m) = Eigen::Vector3d(count, count + 0.25, count + 0.5);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
      if (f != 5) continue;
      markers.state[markers.index(f, m)] = data::SampleState::interpolated;
      markers.set_method(f, m, "cubic");
    }
  trial.channels = {.names = {"angle", "moment"},
                    .kinds = {data::ChannelKind::angle, data::ChannelKind::moment},
                    .units = {"deg", "Nmm"},
                    .rate_hz = 100.0,
                    .frames = kFrames,
                    .values = {}};
  for (std::int64_t i = 0; i < kFrames * kChannels * 3; ++i)
    trial.channels.values.push_back(static_cast<double>(i));
  trial.analog = {.names = {"Fx", "Fz"},
                  .units = {"N", "N"},
                  .rate_hz = 500.0,
                  .samples = kFrames * kPerFrame,
                  .values = {}};
  for (std::int64_t i = 0; i < kFrames * kPerFrame * kAnalog; ++i)
    trial.analog.values.push_back(static_cast<double>(i));
  return trial;
}

}  // namespace kinemark::trajectory::testing

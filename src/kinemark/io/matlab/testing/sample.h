// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/data/trial.h"

namespace kinemark::io::testing {

/// Header of a file, little endian, and variables.
inline std::string mat_file(const std::vector<std::string>& variables) {
  std::string out = "MATLAB 5.0 MAT-file, by a test";
  out.resize(124, ' ');
  out += std::string_view("\0\1IM", 4);
  for (const std::string& variable : variables) out += variable;
  return out;
}

/// 3 frames of 2 markers in every state but upsampled, with all that a trial can know of them; the numbers
/// are their own places.
inline data::Trial full_trial() {
  using data::SampleState;
  data::Trial t;
  t.source = "walk.c3d";
  t.software = "maker";
  t.first_frame = 13;
  t.markers =
      data::Trajectories::all_missing({"LASI", "Übung 2"}, {.rate_hz = 119.88, .t0_s = 0.1001, .frames = 3});
  const SampleState states[] = {SampleState::measured,     SampleState::missing,  SampleState::interpolated,
                                SampleState::model_filled, SampleState::rejected, SampleState::measured};
  t.markers.covariance.assign(36, 0.0);
  t.residual_m.assign(6, static_cast<float>(kNaN));
  t.camera_mask.assign(6, 0);
  for (int i = 0; i < 6; ++i) {
    t.markers.state[i] = states[i];
    for (int k = 0; k < 6; ++k) t.markers.covariance[6 * i + k] = 1e-6 * (6 * i + k + 1);
    if (states[i] == SampleState::missing || states[i] == SampleState::rejected) continue;
    for (int k = 0; k < 3; ++k) t.markers.x_in_world[3 * i + k] = 0.1 * (3 * i + k) + 1.0 / 3.0;
    t.residual_m[i] = 0.001F * static_cast<float>(i);
    t.camera_mask[i] = static_cast<std::uint8_t>(0x40 + i);
  }
  t.markers.set_method(1, 0, "cubic");
  t.markers.set_method(1, 1, "rigid body");
  t.markers.sample_offset_s = {0.0, 0.002};
  t.markers.filters = {{.method = "kalman", .order = 5, .cutoff_hz = 6.4, .noise_sd_m = 2e-4},
                       {.method = "none", .order = 0, .cutoff_hz = kNaN, .noise_sd_m = kNaN}};
  for (int i = 0; i < 18; ++i) t.markers.unfiltered_in_world.push_back(i % 6 < 3 ? 0.1 * i : kNaN);
  t.channels = {.names = {"LKneeAngles"},
                .kinds = {data::ChannelKind::angle},
                .units = {"deg"},
                .rate_hz = 119.88,
                .frames = 3};
  t.channels.values = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, kNaN};
  t.analog = {.names = {"Fx", "EMG"}, .units = {"N", "V"}, .rate_hz = 239.76, .samples = 6};
  for (int i = 0; i < 12; ++i) t.analog.values.push_back(i - 0.1);
  t.events = {{.label = "Foot Strike", .context = "Left", .time_s = 0.11},
              {.label = "Foot Off", .context = "", .time_s = 0.12}};
  data::ForcePlate plate{.number = 2,
                         .type = 4,
                         .origin_in_plate = {0.1, 0.2, -0.03},
                         .channel_idx = {0, 1},
                         .calibration_rows = 6,
                         .metres_per_unit = 1.0};
  for (int c = 0; c < 4; ++c) plate.corners_in_world[c] = Eigen::Vector3d(c, 0.5 * c, -0.25 * c);
  for (int i = 0; i < 36; ++i) plate.calibration.push_back(i);
  for (int i = 0; i < 12; ++i) plate.pressure_correction.push_back(0.1 * i - 0.3);
  t.force_plates = {plate, {.number = 3, .type = 2}};
  t.unloaded_s = {0.25, 0.5};
  t.calibration_error.fields = {data::CalibrationError::Field::Constant(1.25e-4)};
  return t;
}

/// Random positions, every fifth sample missing, and channels of twice the rate.
inline data::Trial sized_trial(std::int64_t markers, std::int64_t frames, std::int64_t channels) {
  Random random(5, 0);
  data::Trial t;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers; ++m) names.push_back("M" + std::to_string(m));
  t.markers = data::Trajectories::all_missing(std::move(names), {.rate_hz = 250.0, .frames = frames});
  for (std::size_t i = 0; i < t.markers.state.size(); ++i) {
    if (i % 5 == 4) continue;
    t.markers.state[i] = data::SampleState::measured;
    for (std::size_t k = 0; k < 3; ++k) t.markers.x_in_world[3 * i + k] = random.uniform(-2.0, 2.0);
  }
  if (channels == 0) return t;
  t.analog.rate_hz = 500.0;
  t.analog.samples = 2 * frames;
  for (std::int64_t c = 0; c < channels; ++c) t.analog.names.push_back("F" + std::to_string(c));
  t.analog.units.assign(t.analog.names.size(), "N");
  t.analog.values.resize(static_cast<std::size_t>(2 * frames * channels));
  for (double& v : t.analog.values) v = random.uniform(-800.0, 800.0);
  return t;
}

}  // namespace kinemark::io::testing

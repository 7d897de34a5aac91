// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording with one of everything, for the tests of this folder.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/io/nwb/nwb.h"

namespace kinemark::io::testing {

inline void fill(Array<double>& values, std::size_t count, double low, double high, Random& random) {
  values.resize(count);
  for (double& v : values) v = random.uniform(low, high);
}

/// Every state, three methods, covariances, offsets of every sample, awkward names and numbers.
inline data::Trajectories sample_trajectories(std::int64_t frames = 50) {
  Random random(7, 0);
  auto t =
      data::Trajectories::all_missing({"Subject:LASI", "a/b", "a_b", ".", "C7 \xC3\xA9"},
                                      {.rate_hz = 60000.0 / 1001.0, .t0_s = 1.0 / 3.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      const auto state = static_cast<data::SampleState>((f + m) % 6);
      t.state[t.index(f, m)] = state;
      if (!t.present(f, m)) continue;
      for (double& x : t.x(f, m)) x = random.uniform(-2.0, 2.0);
      if (state == data::SampleState::interpolated) t.set_method(f, m, "cubic");
      if (state == data::SampleState::model_filled) t.set_method(f, m, m == 1 ? "rigid body" : "PCA");
    }
  }
  t.x(1, 0) = Eigen::Vector3d(-0.0, 5e-324, 1e300);
  fill(t.covariance, 6 * t.state.size(), 1e-9, 1e-6, random);
  fill(t.sample_offset_s, t.state.size(), 0.0, 0.01, random);
  fill(t.unfiltered_in_world, t.x_in_world.size(), -2.0, 2.0, random);
  t.unfiltered_in_world[2] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t m = 0; m < t.names.size(); ++m)
    t.filters.push_back({.method = m == 0 ? "none" : "kalman",
                         .order = static_cast<int>(m),
                         .cutoff_hz = m == 0 ? std::numeric_limits<double>::quiet_NaN() : 6.1,
                         .noise_sd_m = 1e-4});
  return t;
}

inline data::Derivatives sample_derivatives(const data::Trajectories& of) {
  Random random(8, 0);
  data::Derivatives d;
  for (auto* values : {&d.velocity, &d.acceleration, &d.jerk})
    fill(*values, of.x_in_world.size(), -3.0, 3.0, random);
  for (auto* values : {&d.velocity_sd, &d.acceleration_sd, &d.jerk_sd})
    fill(*values, of.x_in_world.size(), 0.0, 1.0, random);
  d.velocity[4] = std::numeric_limits<double>::quiet_NaN();
  d.filters = of.filters;
  return d;
}

inline NwbMetadata sample_metadata() {
  return {.identifier = "trial 7",
          .session_description = "reaching",
          .session_start = "2026-11-21T09:30:00.250+01:00",
          .created = "2026-11-21T12:00:00Z",
          .reference_frame = "lab, Z up",
          .subject_id = "M1",
          .species = "Macaca mulatta",
          .sex = "F",
          .age = "P8Y",
          .software = "kinemark",
          .version = "0.1.0",
          .command = "kinemark clean \"a b.c3d\" out.nwb",
          .sources = {{.file = "a b.c3d", .bytes = 123456789012, .xxh3 = "0123456789abcdef"},
                      {.file = "rig.toml", .bytes = 12, .xxh3 = ""}},
          .options = {{"gaps", "auto"}, {"filter", ""}},
          .seed = 18446744073709551615ULL};
}

/// Two plates that are wired, one of them calibrated, and one that is not.
inline std::vector<data::ForcePlate> sample_plates() {
  data::ForcePlate plate{.number = 1, .type = 2, .channel_idx = {0, 2}, .metres_per_unit = 1e-3};
  for (std::size_t c = 0; c < 4; ++c)
    plate.corners_in_world[c] = Eigen::Vector3d(1.0 / 3.0, 0.1, -0.0) * static_cast<double>(c);
  data::ForcePlate calibrated{.number = 7,
                              .type = 4,
                              .origin_in_plate = {0.1, 0.2, -0.03},
                              .channel_idx = {4, 3, 1},
                              .calibration = {1.5, std::numeric_limits<double>::quiet_NaN(), -2.0, 0.1},
                              .calibration_rows = 2,
                              .metres_per_unit = 1.0};
  for (int i = 0; i < 12; ++i) calibrated.pressure_correction.push_back(0.1 * i - 0.3);
  return {plate, calibrated, {.number = 3, .type = 1}};
}

/// All that a trial can hold but groups of parameters; analog channels of four units at a rate of their own.
inline data::Trial sample_trial(std::int64_t frames = 50) {
  Random random(9, 0);
  data::Trial t;
  t.first_frame = 165;
  t.markers = sample_trajectories(frames);
  for (std::size_t i = 0; i < t.markers.state.size(); ++i) {
    t.residual_m.push_back(i % 3 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(random.uniform(0.0, 1e-3)));
    t.camera_mask.push_back(static_cast<std::uint8_t>(i % 128));
  }
  t.channels = {.names = {"LKneeAngles", "a/b"},
                .kinds = {data::ChannelKind::angle, data::ChannelKind::modeled_marker},
                .units = {"deg", ""},
                .rate_hz = t.markers.time.rate_hz,
                .frames = frames};
  fill(t.channels.values, static_cast<std::size_t>(6 * frames), -90.0, 90.0, random);
  t.channels.values[3] = std::numeric_limits<double>::quiet_NaN();
  t.analog = {.names = {"Fx1", "EMG/a", "Fz1", "", "Fx1"},
              .units = {"N", "mV", "N", "", "Nmm/V"},
              .rate_hz = 1000.0 / 3.0,
              .samples = 4 * frames + 1};
  fill(t.analog.values, static_cast<std::size_t>(5 * t.analog.samples), -1e3, 1e3, random);
  t.events = {{.label = "Foot Off", .context = "Right", .time_s = 0.7},
              {.label = "Foot Strike", .context = "Left", .time_s = 1.0 / 3.0},
              {.label = "", .context = "", .time_s = 0.0}};
  t.force_plates = sample_plates();
  t.unloaded_s = {1.0 / 3.0, 0.4};
  t.calibration_error.fields = {data::CalibrationError::Field::Constant(1.25e-4)};
  return t;
}

/// Equal to the last bit; one NaN is as good as another.
inline bool same_bits(const Array<double>& a, const Array<double>& b) {
  return std::ranges::equal(a, b, [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (x != x && y != y);
  });
}

}  // namespace kinemark::io::testing

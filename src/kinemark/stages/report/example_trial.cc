// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/example_trial.h"

namespace kinemark::report::internal {

namespace {

using data::FrameStatus;
using data::SampleState;

struct Wave {
  std::string_view name;
  bool is_rotation;
  double mean, amplitude, phase;  ///< deg or m; rad
  double sd;                      ///< deg or m
};

constexpr std::array<Wave, 20> kWaves{
    {{"pelvis_tilt", true, -4, 2.5, 0.2, 0.35},      {"pelvis_list", true, 0, 4, 1.1, 0.3},
     {"pelvis_rotation", true, 0, 6, 2.0, 0.4},      {"pelvis_tx", false, 0.6, 0.02, 0.0, 0.0011},
     {"pelvis_ty", false, 0.94, 0.021, 0.7, 0.0009}, {"pelvis_tz", false, 0.02, 0.018, 1.9, 0.001},
     {"hip_flexion_r", true, 12, 22, 0.0, 0.6},      {"hip_adduction_r", true, -2, 6, 1.3, 0.5},
     {"hip_rotation_r", true, 1, 8, 2.2, 1.6},       {"knee_angle_r", true, -28, 27, 0.9, 0.7},
     {"ankle_angle_r", true, 2, 14, 2.4, 0.9},       {"subtalar_angle_r", true, 0, 5, 0.5, 0.0},
     {"hip_flexion_l", true, 12, 22, 3.1, 0.6},      {"hip_adduction_l", true, -2, 6, 4.4, 0.5},
     {"knee_angle_l", true, -28, 27, 4.0, 0.7},      {"ankle_angle_l", true, 2, 14, 5.5, 0.9},
     {"arm_flex_r", true, 5, 18, 3.0, 1.1},          {"elbow_flex_r", true, 35, 16, 3.4, 1.2},
     {"pro_sup_r", true, 60, 9, 1.0, 2.8},           {"wrist_flex_r", true, 4, 7, 2.1, 2.1}}};
constexpr std::size_t kLocked = 11, kForearm = 18;  // the wrist follows the forearm

constexpr std::array<std::string_view, 30> kMarkers{
    "R.ASIS",      "L.ASIS",     "V.Sacral",      "R.Thigh.Upper", "R.Thigh.Front", "R.Thigh.Rear",
    "R.Knee.Lat",  "R.Knee.Med", "R.Shank.Upper", "R.Shank.Front", "R.Ankle.Lat",   "R.Heel",
    "R.Midfoot",   "R.Toe.Tip",  "L.Thigh.Upper", "L.Thigh.Front", "L.Knee.Lat",    "L.Shank.Upper",
    "L.Ankle.Lat", "L.Heel",     "L.Midfoot",     "L.Toe.Tip",     "R.Acromium",    "L.Acromium",
    "Top.Head",    "R.Bicep",    "R.Elbow",       "R.Forearm",     "R.Wrist.Ulna",  "R.Wrist.Rad"};
constexpr std::size_t kUlna = 28, kRadius = 29;

/// Frames in which the right wrist is behind the body.
bool wrist_hidden(std::int64_t f) {
  return (f % 1800 >= 215 && f % 1800 < 290) || (f % 1800 >= 430 && f % 1800 < 452);
}

void fill_coordinates(ExampleTrial& t) {
  data::JointMotion& m = t.motion;
  for (const Wave& w : kWaves) {
    m.coordinates.emplace_back(w.name);
    m.is_rotation.push_back(w.is_rotation);
  }
  for (std::int64_t f = 0; f < m.frames(); ++f) {
    const double angle = 2.0 * std::numbers::pi * 0.9 * m.time.time_s(f);
    for (std::size_t j = 0; j < kWaves.size(); ++j) {
      const Wave& w = kWaves[j];
      const std::size_t i = m.index(f, static_cast<std::int64_t>(j));
      const double unit = w.is_rotation ? kRadPerDeg : 1.0;
      const bool locked = j == kLocked;
      const double shape = std::sin(angle + w.phase) + 0.35 * std::sin(2.0 * angle + 1.7 * w.phase);
      m.q[i] = locked ? 0.0 : unit * (w.mean + w.amplitude * shape);
      // The error grows around the time in which the wrist is hidden.
      const bool near = wrist_hidden(f + 12) || wrist_hidden(f - 12);
      m.determined[i] = locked || !(wrist_hidden(f) && j >= kForearm);
      m.q_sd[i] = locked ? kNaN : unit * w.sd * (1.0 + 0.3 * std::cos(angle)) * (near && j >= 17 ? 2.6 : 1.0);
      if (m.determined[i] == 0) m.q_sd[i] = kNaN;
    }
  }
}

void fill_markers(ExampleTrial& t, std::uint64_t seed) {
  data::JointMotion& m = t.motion;
  for (std::size_t k = 0; k < kMarkers.size(); ++k) {
    Random random(seed, k);
    const double noise_m = 0.0006 + 0.0005 * random.uniform();
    const double skin_m = (k % 3 == 1 ? 0.008 : 0.003) * (0.6 + random.uniform());
    const double dropout = k % 5 == 4 ? 0.004 : 0.0004;
    std::int64_t gone_until = -1;
    for (std::int64_t f = 0; f < m.frames(); ++f) {
      const double angle = 2.0 * std::numbers::pi * 0.9 * m.time.time_s(f);
      if (random.uniform() < dropout) gone_until = f + 3 + static_cast<std::int64_t>(20.0 * random.uniform());
      const bool hidden = (k == kUlna || k == kRadius) && wrist_hidden(f);
      const std::size_t i = static_cast<std::size_t>(f) * kMarkers.size() + k;
      const bool swapped = k == 12 && f % 900 >= 355 && f % 900 < 361;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double skin =
            skin_m * std::sin(angle + static_cast<double>(axis) + 0.7 * static_cast<double>(k));
        const double e = skin + noise_m * random.gaussian() + (swapped && axis == 1 ? 0.043 : 0.0);
        m.marker_error[3 * i + axis] = hidden || f < gone_until ? kNaN : e;
      }
      SampleState& state = t.markers.state[t.markers.index(f, static_cast<std::int64_t>(k))];
      state = hidden || f < gone_until ? SampleState::missing : SampleState::measured;
      if (k == 5 && f % 300 >= 120 && f % 300 < 141) state = SampleState::interpolated;
      if (swapped && f % 900 == 358) {
        state = SampleState::rejected;
        for (std::size_t axis = 0; axis < 3; ++axis) m.marker_error[3 * i + axis] = kNaN;
      }
    }
    m.markers.emplace_back(kMarkers[k]);
    t.run.fit.markers.push_back({.name = std::string(kMarkers[k]),
                                 .weight = k < 3 ? 10.0 : 1.0,
                                 .noise_sd_m = noise_m + 0.4 * skin_m,
                                 .common_sd_m = 0.0});
  }
}

void fill_run(ExampleTrial& t) {
  IkRun& run = t.run;
  run.trial = "walk_03.trc";
  run.model = "human-scaled";
  run.method = "least squares";
  run.version = "0.1.0";
  run.command_line = "kinemark ik --model human_scaled.osim --markers walk_03.trc --output walk_03.mot";
  run.solve_s = static_cast<double>(t.motion.frames()) / 14200.0;
  run.options = {{"accuracy", "1e-9"},
                 {"noise", "estimated per marker and segment"},
                 {"robust", "none"},
                 {"time_range", "whole file"}};
  run.inputs = {{"model", "human_scaled.osim", 184320, "9f1c6a0be2d4775a", "XXH3-64"},
                {"markers", "walk_03.trc", 431207, "03b5d8e17c9aa4f2", "XXH3-64"}};
  run.gates = {
      {"marker_rms", true, 6.1, 20.0, "mm", "RMS marker error is 6.1 mm; the bound is 20 mm."},
      {"not_converged", false, 0.5, 0.1, "%",
       "0.5 % of the frames did not converge; the bound is 0.1 %. Look at the frames listed below."}};
  run.exit_status = 1;
  run.locked_coordinates = {std::string(kWaves[kLocked].name)};
  run.fit.excluded.push_back({"L.Bicep", "it is at the origin in every frame."});
  run.warnings = {"walk_03.trc: the header says 612 frames; 600 are there."};
}

}  // namespace

ExampleTrial example_trial(std::int64_t frames, std::uint64_t seed) {
  check(frames >= 100, "an example trial needs at least 100 frames");
  ExampleTrial t;
  const auto F = static_cast<std::size_t>(frames);
  t.motion.time = {.rate_hz = 100.0, .t0_s = 0.5, .frames = frames};
  t.motion.q.resize(F * kWaves.size());
  t.motion.q_sd.resize(F * kWaves.size());
  t.motion.determined.resize(F * kWaves.size());
  t.motion.marker_error.resize(3 * F * kMarkers.size());
  t.motion.status.assign(F, FrameStatus::converged);
  std::vector<std::string> names(kMarkers.begin(), kMarkers.end());
  names.emplace_back("L.Bicep");
  t.markers = data::Trajectories::all_missing(std::move(names), t.motion.time);
  fill_coordinates(t);
  fill_markers(t, seed);
  fill_run(t);
  for (std::int64_t f = 0; f < frames; ++f) {
    for (std::int64_t k = 0; k < t.markers.markers(); ++k)
      if (t.markers.present(f, k))
        t.markers.x(f, k) = Eigen::Vector3d(0.01 * static_cast<double>(k), 1.0, 0.5);
    t.markers.state[t.markers.index(f, t.markers.markers() - 1)] = SampleState::measured;
    t.markers.x(f, t.markers.markers() - 1).setZero();
    auto& status = t.motion.status[static_cast<std::size_t>(f)];
    if (wrist_hidden(f)) status = FrameStatus::underdetermined;
    if (f % 900 >= 356 && f % 900 < 359) status = FrameStatus::not_converged;
  }
  return t;
}

}  // namespace kinemark::report::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/control_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"
#include "studies/taichi/landmarks.h"

namespace kinemark::studies {
namespace {

using Names = std::vector<std::string>;

const Names kPelvis{"Pelvis", "RHip", "LHip"};
const Names kUpperBody{"Thorax", "Neck",   "BHead",  "FHead",  "RShoulder", "LShoulder",
                       "RElbow", "LElbow", "RWrist", "LWrist", "RHand",     "LHand"};

Names joined(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Squares and the largest of some errors.
struct Sum {
  double square = 0.0, count = 0.0, most = 0.0;
  void add(double error) {
    square += error * error;
    count += 1.0;
    if (!std::isnan(most) && !(std::abs(error) <= most)) most = std::abs(error);  // keeps what is no number
  }
  [[nodiscard]] double rms() const {
    return count > 0.0 ? std::sqrt(square / count) : std::numeric_limits<double>::quiet_NaN();
  }
};

Sum landmark_errors(const data::JointMotion& motion, std::int64_t first) {
  Sum sum;
  const auto markers = static_cast<std::int64_t>(motion.markers.size());
  for (std::int64_t i = first * markers; i < motion.frames() * markers; ++i)
    if (const Eigen::Map<const Eigen::Vector3d> error(motion.marker_error.data() + 3 * i); error.allFinite())
      sum.add(error.norm());
  return sum;
}

bool contains(const Names& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

Names LandmarkSet::all() const {
  Names out;
  for (const auto& level : levels) out = joined(std::move(out), level);
  return out;
}

LandmarkSet paper_set() { return {"2 landmarks, then 2", {{"RShoulder", "LWrist"}, {"LElbow", "RWrist"}}}; }
LandmarkSet pelvis_paper_set() {
  return {"pelvis, then 2, then 2", {kPelvis, {"RShoulder", "LWrist"}, {"LElbow", "RWrist"}}};
}
LandmarkSet upper_body_set() { return {"upper body", {kUpperBody}}; }
LandmarkSet upper_body_pelvis_set() { return {"upper body and pelvis", {joined(kUpperBody, kPelvis)}}; }
LandmarkSet whole_body_set() { return {"whole body", {{kTaiChiLandmarks.begin(), kTaiChiLandmarks.end()}}}; }
LandmarkSet three_level_set() {
  const Names trunk{"Pelvis", "RHip", "LHip", "Thorax", "Neck"};
  const Names middle{"BHead", "FHead", "RShoulder", "LShoulder", "RElbow", "LElbow", "RKnee", "LKnee"};
  Names ends;
  for (const auto landmark : kTaiChiLandmarks)
    if (const std::string name(landmark); !contains(trunk, name) && !contains(middle, name))
      ends.push_back(name);
  return {"whole body, 3 levels", {trunk, middle, ends}};
}

Eigen::VectorXd first_pose(const data::JointMotion& motion) {
  check(motion.frames() > 0, "first_pose() needs a frame");
  return Eigen::Map<const Eigen::VectorXd>(motion.q.data(), static_cast<Eigen::Index>(motion.size()));
}

Result<motion::TrackResult> run_control(const model::Model& model, const data::Trajectories& goals,
                                        const LandmarkSet& set, const ControlSetting& setting,
                                        const Eigen::VectorXd& rest) {
  constexpr double kCoarse_s = 0.005, kFast_rad_s = 100.0, kSlow_rad_s = 30.0;
  check(rest.size() == model.coordinate_count(), "the rest pose has a number per coordinate");
  motion::TrackOptions options;
  for (const auto& level : set.levels) options.levels.push_back({.markers = level});
  options.strict = true;
  options.step_s = setting.step_s;
  options.omega_rad_s = setting.omega_rad_s > 0.0    ? setting.omega_rad_s
                        : setting.step_s > kCoarse_s ? kSlow_rad_s
                                                     : kFast_rad_s;
  options.damping = setting.damping;
  options.cutoff_hz = 0.0;
  options.limits = setting.limits;
  options.posture_kp = setting.posture_kp;
  options.posture_kd = setting.posture_kd;
  options.error_bars = setting.error_bars;
  options.judge_samples = false;  // as least squares beside it, on the same goals
  // Half a frame off, so that rounding decides nothing.
  const double frame_s = 1.0 / goals.time.rate_hz;
  if (setting.first_frame > 0) options.first_time_s = goals.time.time_s(setting.first_frame) - 0.5 * frame_s;
  if (setting.last_frame >= 0) options.last_time_s = goals.time.time_s(setting.last_frame) + 0.5 * frame_s;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& coordinate = model.coordinates()[static_cast<std::size_t>(c)];
    const auto& described = model.description().coordinates[static_cast<std::size_t>(c)];
    if (coordinate.free_joint < 0 && coordinate.source < 0 && !described.locked)
      options.rest_pose.push_back({.coordinate = described.name, .value = rest[c]});
  }
  return motion::track_markers(model, goals, options);
}

ControlComparison compare(const model::Model& model, const motion::TrackResult& control,
                          const motion::IkResult& least_squares, std::string set,
                          const data::JointMotion* truth) {
  constexpr double kBeyondFirstOrder = 0.01 * kRadPerDeg;
  // rad: both stop where a step gains less than 1e-10 of the cost, which leaves a nearly undetermined angle
  // (an arm almost stretched) open by more than 1e-5.
  constexpr double kRounding = 1e-4;
  const auto& ours = control.motion;
  const auto& theirs = least_squares.motion;
  check(ours.coordinates == theirs.coordinates, "compare() needs motions of one model");
  const auto shift = control.fit.first_frame - least_squares.fit.first_frame;
  check(shift >= 0 && shift + ours.frames() <= theirs.frames(), "least squares covers the tracked frames");
  ControlComparison out{.set = std::move(set)};
  const auto first = std::min(static_cast<std::int64_t>(std::llround(ours.time.rate_hz)), ours.frames());
  const auto errors = landmark_errors(ours, first);
  out.control_rms_m = errors.rms();
  out.control_max_m = errors.most;
  const auto fitted = landmark_errors(theirs, first + shift);
  out.least_squares_rms_m = fitted.rms();
  out.least_squares_max_m = fitted.most;
  Sum determined, all, ours_off, theirs_off;
  for (std::int64_t c = 0; c < ours.size(); ++c) {
    const auto& name = ours.coordinates[static_cast<std::size_t>(c)];
    const auto& described = model.description().coordinates[static_cast<std::size_t>(c)];
    // The angles of the free root are a matter of convention.
    const bool root = model.coordinates()[static_cast<std::size_t>(c)].free_joint >= 0;
    if (root || described.locked) continue;
    ++out.coordinates;
    const bool is_determined =
        !contains(control.undetermined_coordinates, name) && !contains(control.locked_coordinates, name);
    out.determined += is_determined;
    const auto true_c = truth != nullptr ? truth->find(name) : -1;
    for (std::int64_t f = first; f < ours.frames(); ++f) {
      const double error = std::remainder(ours.q[ours.index(f, c)] - theirs.q[theirs.index(f + shift, c)],
                                          2.0 * std::numbers::pi);
      all.add(error);
      if (!is_determined) continue;
      ++out.values;
      // Around a stretched arm an angle may be undetermined for some frames.
      if (!ours.determined.empty() && ours.determined[ours.index(f, c)] == 0) continue;
      ++out.determined_values;
      determined.add(error);
      // Both equations hold where all levels together have full rank.
      if (!control.goal_bound.empty() &&
          ours.status[static_cast<std::size_t>(f)] == data::FrameStatus::converged) {
        ++out.bounded;
        const double bound = control.goal_bound[ours.index(f, c)], way = control.goal_error[ours.index(f, c)];
        out.held_15 += std::abs(error) <= (std::isnan(way) ? bound : std::abs(way)) + kBeyondFirstOrder;
        out.held_16 += std::abs(error) <= bound + kRounding;
      }
      if (true_c < 0) continue;
      const double angle = truth->q[truth->index(f + control.fit.first_frame, true_c)];
      ours_off.add(std::remainder(ours.q[ours.index(f, c)] - angle, 2.0 * std::numbers::pi));
      theirs_off.add(std::remainder(theirs.q[theirs.index(f + shift, c)] - angle, 2.0 * std::numbers::pi));
    }
  }
  out.angle_rms_rad = determined.rms();
  out.angle_max_rad = determined.most;
  out.all_angles_rms_rad = all.rms();
  if (truth != nullptr) {
    out.control_truth_rms_rad = ours_off.rms();
    out.least_squares_truth_rms_rad = theirs_off.rms();
  }
  const auto [low, high] = std::ranges::minmax_element(control.rank);
  out.rank_min = *low;
  out.rank_max = *high;
  out.free_speeds = control.free_speeds;
  out.flagged_frames = control.flagged_frames;
  out.us_per_step =
      1e6 * control.solve_seconds / static_cast<double>(std::max<std::int64_t>(1, control.steps));
  return out;
}

}  // namespace kinemark::studies

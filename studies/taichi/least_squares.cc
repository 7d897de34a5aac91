// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/least_squares.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "studies/taichi/landmarks.h"

namespace kinemark::studies {

namespace {

/// Whether some clamped coordinate of the frame is within 0.1 of its range's end.
bool near_a_limit(const model::Model& model, const data::JointMotion& motion, std::int64_t f) {
  constexpr double kNear_rad = 0.1;
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto& coordinate = model.description().coordinates[static_cast<std::size_t>(c)];
    if (!coordinate.clamped || coordinate.locked) continue;
    const double q = motion.q[motion.index(f, c)];
    if (q < coordinate.range_min + kNear_rad || q > coordinate.range_max - kNear_rad) return true;
  }
  return false;
}

}  // namespace

motion::IkOptions landmark_ik_options(const data::ModelDescription& model,
                                      std::span<const std::string> landmarks) {
  // Of the sum of squared distances; few landmarks leave much undetermined, which must not affect them.
  constexpr double kStill_m2 = 1e-6, kStillFew_m2 = 1e-8, kClavicle_m2 = 1e-3;
  constexpr std::size_t kFew = 6;
  motion::IkOptions options;
  options.limits = false;
  options.error_bars = false;
  options.judge_samples = false;  // control follows every sample
  const auto count = landmarks.empty() ? model.markers.size() : landmarks.size();
  if (!landmarks.empty()) {
    options.default_marker_weight = 0.0;
    for (const auto& name : landmarks) options.marker_weights.push_back({.marker = name, .weight = 1.0});
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (model.joints[j].parent_body_idx == data::kGround) continue;
    for (const auto& axis : model.joints[j].axes) {
      if (axis.coordinate_idx < 0) continue;
      const auto& coordinate = model.coordinates[static_cast<std::size_t>(axis.coordinate_idx)];
      if (coordinate.locked) continue;
      const double still = coordinate.name.starts_with("clav") ? kClavicle_m2
                           : count < kFew                      ? kStillFew_m2
                                                               : kStill_m2;
      // The cost is a mean over landmarks.
      options.coordinate_tasks.push_back(
          {.coordinate = coordinate.name, .weight = still / static_cast<double>(count)});
    }
  }
  return options;
}

motion::IkOptions reference_ik_options(const data::ModelDescription& model,
                                       std::span<const std::string> landmarks) {
  constexpr double kWeaker = 1e-6;
  auto options = landmark_ik_options(model, landmarks);
  options.limits = true;
  for (auto& task : options.coordinate_tasks) task.weight *= kWeaker;
  return options;
}

Result<motion::IkResult> reference_ik(const model::Model& model, const data::Trajectories& goals,
                                      const motion::IkOptions& options) {
  auto forth = motion::solve_ik(model, goals, options);
  if (!forth) return forth;
  const auto F = goals.frames();
  auto turned = data::Trajectories::all_missing(goals.names, goals.time);
  for (std::int64_t f = 0; f < F; ++f)
    for (std::int64_t m = 0; m < goals.markers(); ++m) {
      turned.x(f, m) = goals.x(F - 1 - f, m);
      turned.state[turned.index(f, m)] = goals.state[goals.index(F - 1 - f, m)];
    }
  const auto back = motion::solve_ik(model, turned, options);
  if (!back) return back;
  auto& motion = forth->motion;
  const auto numbers = 3 * static_cast<std::int64_t>(motion.markers.size());
  const auto cost = [&](const data::JointMotion& of, std::int64_t f) {
    double sum = 0.0;
    for (std::int64_t i = f * numbers; i < (f + 1) * numbers; ++i)
      if (const double e = of.marker_error[static_cast<std::size_t>(i)]; !std::isnan(e)) sum += e * e;
    return sum;
  };
  const auto take_better = [&](const data::JointMotion& from, std::int64_t g, std::int64_t f) {
    if (!(cost(from, g) < cost(motion, f))) return;
    std::copy_n(from.q.data() + from.index(g, 0), motion.size(), motion.q.data() + motion.index(f, 0));
    std::copy_n(from.marker_error.data() + g * numbers, numbers, motion.marker_error.data() + f * numbers);
    motion.status[static_cast<std::size_t>(f)] = from.status[static_cast<std::size_t>(g)];
  };
  for (std::int64_t f = 0; f < F; ++f) take_better(back->motion, F - 1 - f, f);
  auto single = options;
  for (std::int64_t f = 0; f < F; ++f) {
    if (!near_a_limit(model, motion, f)) continue;
    single.first_time_s = goals.time.time_s(f) - 0.5 / goals.time.rate_hz;
    single.last_time_s = goals.time.time_s(f) + 0.5 / goals.time.rate_hz;
    const auto alone = motion::solve_ik(model, goals, single);
    if (!alone) return alone;
    take_better(alone->motion, 0, f);
  }
  return forth;
}

data::Trajectories carried_landmarks(const model::Model& model, const data::JointMotion& motion) {
  std::vector<std::string> names;
  for (const auto& marker : model.description().markers) names.push_back(marker.name);
  auto out = data::Trajectories::all_missing(std::move(names), motion.time);
  model::Workspace w(model);
  const auto n = static_cast<Eigen::Index>(motion.size());
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(motion.q.data() + motion.index(f, 0), n);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = w.marker.col(m);
      out.state[out.index(f, m)] = data::SampleState::model_filled;
    }
  }
  return out;
}

double landmark_rms(const data::JointMotion& motion, std::int64_t first, std::int64_t last) {
  const auto markers = static_cast<std::int64_t>(motion.markers.size());
  double sum = 0.0, count = 0.0;
  for (std::int64_t i = first * markers; i < last * markers; ++i) {
    const Eigen::Map<const Eigen::Vector3d> error(motion.marker_error.data() + 3 * i);
    if (!error.allFinite()) continue;
    sum += error.squaredNorm();
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

double landmark_max(const data::JointMotion& motion) {
  double most = 0.0;
  for (std::size_t i = 0; i + 2 < motion.marker_error.size(); i += 3)
    if (const Eigen::Map<const Eigen::Vector3d> error(motion.marker_error.data() + i); error.allFinite())
      most = std::max(most, error.norm());
  return most;
}

}  // namespace kinemark::studies

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/start.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmallestStep = 1e-10;  // rad or m
constexpr double kPoor = 2.0;            // SD over the usual one, above which a path is bridged
constexpr double kSmallestDoubt = 1e-12, kUnknown = 1.0;  // rad^2 or m^2
constexpr double kAnyNoise = std::numeric_limits<double>::infinity();
// Default third difference at 100 Hz, from a typical jerk of human motion, 100 rad/s^3.
constexpr double kUsualStep = 1e-4, kUsualRate_hz = 100.0;

/// Every stretch of frames [first, last] in which `good` is false.
template <class Good, class Visit>
void each_gap(std::int64_t frames, const Good& good, const Visit& visit) {
  for (std::int64_t f = 0; f < frames; ++f) {
    if (good(f)) continue;
    std::int64_t last = f;
    while (last + 1 < frames && !good(last + 1)) ++last;
    visit(f, last);
    f = last;
  }
}

bool determined(const data::JointMotion& motion, std::int64_t f, int c) {
  return motion.determined.empty() || motion.determined[motion.index(f, c)] != 0;
}

bool joint_determined(const data::JointMotion& motion, const model::Model::FreeJoint& free, std::int64_t f) {
  for (int i = 0; i < 3; ++i)
    if (!determined(motion, f, free.rotation_coordinate[i]) ||
        !determined(motion, f, free.translation_coordinate[i]))
      return false;
  return true;
}

void bridge_joint(const model::Model& model, const data::JointMotion& motion,
                  const model::Model::FreeJoint& free, MatrixXd& states) {
  const std::int64_t F = motion.frames();
  const auto good = [&](std::int64_t f) { return joint_determined(motion, free, f); };
  VectorXd from, way, whole;
  each_gap(F, good, [&](std::int64_t first, std::int64_t last) {
    const bool before = first > 0, after = last + 1 < F;
    if (!before && !after) return;
    const std::int64_t left = before ? first - 1 : last + 1, right = after ? last + 1 : first - 1;
    model::difference(model, states.col(left), states.col(right), whole);
    for (std::int64_t f = first; f <= last; ++f) {
      const double share =
          before && after ? static_cast<double>(f - left) / static_cast<double>(right - left) : 0.0;
      from = states.col(left);
      way.setZero(model.speed_count());
      way.segment<6>(free.speed_idx) = share * whole.segment<6>(free.speed_idx);
      model::integrate(model, from, way);
      states.col(f).segment<7>(free.state_idx) = from.segment<7>(free.state_idx);
    }
  });
}

/// SD of a frame's coordinates, NaN where one of them is not determined: root mean square.
double pooled_sd(const data::JointMotion& motion, std::int64_t f, const int (&coordinates)[3]) {
  double squares = 0.0;
  for (const int c : coordinates) {
    if (!determined(motion, f, c)) return kNaN;
    const double sd = motion.q_sd.empty() ? 1.0 : motion.q_sd[motion.index(f, c)];
    squares += sd * sd;
  }
  return std::sqrt(squares / 3.0);
}

double usual_of(const std::vector<double>& values, double fallback) {
  return values.empty() ? fallback : math::upper_median(values);
}

}  // namespace

MatrixXd bridged_states(const model::Model& model, const data::JointMotion& motion) {
  const std::int64_t F = motion.frames();
  MatrixXd states(model.state_count(), F);
  VectorXd q(model.coordinate_count());
  for (std::int64_t f = 0; f < F; ++f) {
    std::copy_n(motion.q.data() + motion.index(f, 0), q.size(), q.data());
    states.col(f) = model::state_from_coordinates(model, q);
  }
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const int row = model.coordinates()[at(c)].state_idx;
    if (row < 0) continue;
    each_gap(
        F, [&](std::int64_t f) { return determined(motion, f, c); },
        [&](std::int64_t first, std::int64_t last) {
          const bool before = first > 0, after = last + 1 < F;
          if (!before && !after) return;
          const double left = states(row, before ? first - 1 : last + 1),
                       right = states(row, after ? last + 1 : first - 1);
          for (std::int64_t f = first; f <= last; ++f)
            states(row, f) = left + (right - left) * static_cast<double>(f - first + 1) /
                                        static_cast<double>(last - first + 2);
        });
  }
  for (const auto& free : model.free_joints()) bridge_joint(model, motion, free, states);
  return states;
}

SinglePaths single_paths(const model::Model& model, const data::JointMotion& motion, const MatrixXd& states,
                         double raised) {
  const std::int64_t F = motion.frames();
  SinglePaths paths{.step_variance = VectorXd::Constant(model.speed_count(), kNaN),
                    .value = MatrixXd::Zero(model.speed_count(), F),
                    .doubt = MatrixXd::Zero(model.speed_count(), F)};
  VectorXd& variance = paths.step_variance;
  std::vector<std::uint8_t> is_rotation(at(model.speed_count()), 0);
  std::vector<double> y(at(F)), sd(at(F));
  const auto estimate = [&](int speed) {
    // Noise beyond the error bars would be motion taken for noise.
    const auto smooth =
        smooth_coordinate(y, sd, motion.time.rate_hz, motion.q_sd.empty() ? kAnyNoise : raised);
    if (smooth.known) variance[speed] = std::pow(std::max(smooth.step_sd, kSmallestStep), 2);
    std::vector<double> known;
    std::ranges::copy_if(sd, std::back_inserter(known), [](double s) { return s >= 0.0; });
    const double most = kPoor * usual_of(known, 0.0);
    for (std::int64_t f = 0; f < F; ++f) {
      const bool bridged = !(sd[at(f)] <= most);
      paths.value(speed, f) = bridged ? smooth.value[f] : y[at(f)];
      if (bridged)
        paths.doubt(speed, f) = smooth.known ? std::max(smooth.covariance(0, f), kSmallestDoubt) : kUnknown;
    }
  };
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    if (coordinate.speed_idx < 0) continue;
    is_rotation[at(coordinate.speed_idx)] = motion.is_rotation[at(c)];
    if (model.description().coordinates[at(c)].held()) continue;  // any number will do
    for (std::int64_t f = 0; f < F; ++f) {
      y[at(f)] = states(coordinate.state_idx, f);
      sd[at(f)] =
          determined(motion, f, c) ? (motion.q_sd.empty() ? 1.0 : motion.q_sd[motion.index(f, c)]) : kNaN;
    }
    estimate(coordinate.speed_idx);
  }
  for (const auto& free : model.free_joints()) {
    for (int i = 0; i < 3; ++i) {
      for (std::int64_t f = 0; f < F; ++f) {
        y[at(f)] = states(free.state_idx + i, f);
        sd[at(f)] = pooled_sd(motion, f, free.translation_coordinate);
      }
      estimate(free.speed_idx + i);
    }
    // Rotations add up along the path, in the axes of the body.
    MatrixXd path = MatrixXd::Zero(3, F);
    VectorXd step;
    for (std::int64_t f = 1; f < F; ++f) {
      model::difference(model, states.col(f - 1), states.col(f), step);
      path.col(f) = path.col(f - 1) + step.segment<3>(free.speed_idx + 3);
    }
    for (int i = 0; i < 3; ++i) {
      is_rotation[at(free.speed_idx + 3 + i)] = 1;
      for (std::int64_t f = 0; f < F; ++f) {
        y[at(f)] = path(i, f);
        sd[at(f)] = pooled_sd(motion, f, free.rotation_coordinate);
      }
      estimate(free.speed_idx + 3 + i);
    }
  }
  const double fallback = std::pow(kUsualStep * std::pow(kUsualRate_hz / motion.time.rate_hz, 2.5), 2);
  for (const bool rotation : {true, false}) {
    std::vector<double> known;
    for (Index i = 0; i < variance.size(); ++i)
      if (std::isfinite(variance[i]) && (is_rotation[at(i)] != 0) == rotation) known.push_back(variance[i]);
    const double usual = usual_of(known, fallback);
    for (Index i = 0; i < variance.size(); ++i)
      if (std::isnan(variance[i]) && (is_rotation[at(i)] != 0) == rotation) variance[i] = usual;
  }
  return paths;
}

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Five movements with known derivatives, with noise, to evaluate filters. 100 Hz, 4.4 s, one
// coordinate each.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::testing_support {

inline constexpr double kMovementRateHz = 100.0;
inline constexpr int kMovementFrames = 440;

/// One coordinate through time, m, and its derivatives.
struct Movement {
  std::string name;
  std::vector<double> x, velocity, acceleration;
};

/// A signing hand on an ellipse with uneven rhythm, 0.5 to 2.7 m/s, and the elbow that follows it; mm.
class SigningArm {
 public:
  [[nodiscard]] Eigen::Vector3d hand(double t) const {
    const double phase = 2.0 * M_PI * t / kPeriod;
    const double angle = M_PI / 3.0 + phase + kRhythm * std::sin(phase) + 0.06 * std::sin(2.0 * phase);
    return Eigen::Vector3d(-60.0, 40.0, 150.0 + 6.0 * std::sin(2.0 * M_PI * 0.31 * t)) +
           170.0 * std::cos(angle) * (rotation_ * Eigen::Vector3d::UnitX()) +
           80.0 * std::sin(angle) * (rotation_ * tilt_ * Eigen::Vector3d::UnitY());
  }
  [[nodiscard]] Eigen::Vector3d elbow(double t) const {
    const double phase = 2.0 * M_PI * t / kPeriod;
    const Eigen::Vector3d shoulder =
        Eigen::Vector3d(150.0, 200.0, -130.0) + 8.0 * std::sin(phase + 0.7) * Eigen::Vector3d(0.5, 0.8, 0.3);
    const Eigen::Vector3d palm = (Eigen::Vector3d(-0.35, 0.75, 0.55).normalized() +
                                  0.25 * std::sin(phase + 1.1) * Eigen::Vector3d::UnitX())
                                     .normalized();
    const Eigen::Vector3d reach = hand(t) - 80.0 * palm - shoulder;
    const double length = reach.norm();
    const double along = (310.0 * 310.0 - 280.0 * 280.0 + length * length) / (2.0 * length);
    const Eigen::Vector3d u = reach / length;
    const Eigen::Vector3d swivel = Eigen::Vector3d(0.55, -0.80, -0.25).normalized();
    const Eigen::Vector3d out = (swivel - swivel.dot(u) * u).normalized();
    return shoulder + along * u + std::sqrt(std::max(310.0 * 310.0 - along * along, 1e-6)) * out;
  }

 private:
  static constexpr double kRhythm =
      0.73597096096748993;  ///< these two give 0.5 m/s at least, 2.7 m/s at most
  static constexpr double kPeriod = 0.71888537933151841;  ///< s
  Eigen::Matrix3d rotation_ =
      Eigen::AngleAxisd(25.0 * M_PI / 180.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Matrix3d tilt_ = Eigen::AngleAxisd(40.0 * M_PI / 180.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
};

/// Wheel, signing hand, its elbow, point-to-point reaches (minimum jerk), reaches with a 6 Hz tremor.
inline std::vector<Movement> movements() {
  std::vector<Movement> all{{"wheel", {}, {}, {}},
                            {"hand", {}, {}, {}},
                            {"elbow", {}, {}, {}},
                            {"reach", {}, {}, {}},
                            {"tremor", {}, {}, {}}};
  const SigningArm arm;
  const auto add = [](Movement& m, double x_mm, double v_mm, double a_mm) {
    m.x.push_back(1e-3 * x_mm);
    m.velocity.push_back(1e-3 * v_mm);
    m.acceleration.push_back(1e-3 * a_mm);
  };
  const auto add_slopes = [&](Movement& m, const std::function<double(double)>& p, double t) {
    constexpr double kV = 1e-4, kA = 1e-3;
    add(m, p(t), (p(t - 2 * kV) - 8 * p(t - kV) + 8 * p(t + kV) - p(t + 2 * kV)) / (12 * kV),
        (-p(t - 2 * kA) + 16 * p(t - kA) - 30 * p(t) + 16 * p(t + kA) - p(t + 2 * kA)) / (12 * kA * kA));
  };
  for (int f = 0; f < kMovementFrames; ++f) {
    const double t = f / kMovementRateHz;
    const double w = 2.0 * M_PI * 1.5;
    add(all[0], 196 * std::sin(w * t), 196 * w * std::cos(w * t), -196 * w * w * std::sin(w * t));
    add_slopes(all[1], [&](double s) { return arm.hand(s).x(); }, t);
    add_slopes(all[2], [&](double s) { return arm.elbow(s).y(); }, t);
    double x = 0.0, v = 0.0, a = 0.0, start = 0.3;
    constexpr double kReaches[4][2] = {{300, 0.5}, {-200, 0.35}, {150, 0.6}, {-250, 0.45}};  // mm, s
    for (const auto& [distance, seconds] : kReaches) {
      const double u = std::clamp((t - start) / seconds, 0.0, 1.0);
      x += distance * u * u * u * (10 - 15 * u + 6 * u * u);
      v += distance / seconds * 30 * u * u * (1 - u) * (1 - u);
      if (u < 1.0) a += distance / (seconds * seconds) * (60 * u - 180 * u * u + 120 * u * u * u);
      start += seconds + 0.4;
    }
    add(all[3], x, v, a);
    const double wt = 2.0 * M_PI * 6.0;
    add(all[4], x / 2 + 4 * std::sin(wt * t), v / 2 + 4 * wt * std::cos(wt * t),
        a / 2 - 4 * wt * wt * std::sin(wt * t));
  }
  return all;
}

/// Axes that are copies of one another carry one coordinate's worth of data: what a filter then chooses is
/// what it would choose for that coordinate alone.
enum class Axes { independent, copies };

/// Markers that make a movement along each of their axes, with noise. Axis a of marker m draws from stream
/// `stream` + 3 m + a, or + m where axes are copies; with gaps, three of 8 frames and 3 % of single frames
/// are lost in all axes.
inline data::Trajectories seen_movement(const Movement& movement, double sigma_m, bool gaps, int markers,
                                        std::uint64_t seed, std::uint64_t stream,
                                        Axes axes = Axes::independent) {
  std::vector<std::string> names;
  for (int m = 0; m < markers; ++m) names.push_back(movement.name + std::to_string(m));
  auto t = data::Trajectories::all_missing(names, {kMovementRateHz, 0.0, kMovementFrames});
  const bool copies = axes == Axes::copies;
  for (int m = 0; m < markers; ++m) {
    std::vector<bool> lost(kMovementFrames, false);
    for (int axis = 0; axis < 3; ++axis) {
      Random random(seed, stream + static_cast<std::uint64_t>(copies ? m : 3 * m + axis));
      for (int f = 0; f < kMovementFrames; ++f)
        t.x(f, m)[axis] = movement.x[static_cast<std::size_t>(f)] + sigma_m * random.gaussian();
      if (!gaps || axis > 0) continue;
      for (int gap = 0; gap < 3; ++gap) {
        const int begin = static_cast<int>(random.uniform() * (kMovementFrames - 40)) + 15;
        std::fill_n(lost.begin() + begin, 8, true);
      }
      for (int f = 0; f < kMovementFrames; ++f)
        if (random.uniform() < 0.03) lost[static_cast<std::size_t>(f)] = true;
      for (const int f : {0, 1, 2, kMovementFrames - 3, kMovementFrames - 2, kMovementFrames - 1})
        lost[static_cast<std::size_t>(f)] = false;
    }
    for (int f = 0; f < kMovementFrames; ++f) {
      t.state[t.index(f, m)] = data::SampleState::measured;
      if (lost[static_cast<std::size_t>(f)]) t.set_missing(f, m);
    }
  }
  return t;
}

}  // namespace kinemark::testing_support

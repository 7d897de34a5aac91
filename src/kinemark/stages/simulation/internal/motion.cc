// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/index.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/simulation/internal/streams.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kMarginOfRange = 0.05;
constexpr double kWalkingSpeed_m_s = 1.1;

// Largest excursion of a coordinate, rad or m.
double excursion(MotionKind kind, const data::CoordinateDescription& coordinate) {
  if (!coordinate.is_rotation) return 0.05;
  switch (kind) {
    case MotionKind::walk:
      return 0.35;
    case MotionKind::tai_chi:
      return 0.7;
    case MotionKind::mixed:
      return 0.45;
    case MotionKind::reach: {
      for (const char* part : {"arm", "shoulder", "elbow", "pro_sup", "wrist", "hand", "clav", "scapula"})
        if (coordinate.name.find(part) != std::string::npos) return 0.7;
      return 0.12;
    }
  }
  return 0.0;
}

Vector3d vertical(const model::Model& model) {
  const Vector3d g = model.gravity();
  return g.norm() > 0.0 ? Vector3d(-g.normalized()) : Vector3d(Vector3d::UnitY());
}

}  // namespace

double Wave::operator()(double t_s) const {
  double sum = centre;
  for (const auto& s : sines) sum += s.amplitude * std::sin(kTwoPi * s.frequency_hz * t_s + s.phase);
  return sum;
}

Motion::Motion(const model::Model& model, const SubjectOptions& options)
    : model_(model), options_(options), default_state_(model.default_state()) {
  Random random = stream(options.seed, Draw::root);
  stride_hz_ = random.uniform(0.8, 1.05);
  if (options.motion == MotionKind::walk && options.full_turns != 0.0)
    circle_radius_m_ =
        std::min(3.0, kWalkingSpeed_m_s * options.duration_s / (kTwoPi * std::abs(options.full_turns)));
  waves_.resize(at(model.coordinate_count()));
  for (int c = 0; c < model.coordinate_count(); ++c) draw_coordinate(c);
  roots_.resize(model.free_joints().size());
  for (std::size_t r = 0; r < roots_.size(); ++r) draw_root(r);
}

Wave::Sine Motion::sine(double amplitude, double low_hz, double high_hz, Random& random) const {
  return {amplitude, random.uniform(low_hz, high_hz), random.uniform(0.0, kTwoPi)};
}

void Motion::draw_coordinate(int c) {
  const auto& coordinate = model_.description().coordinates[at(c)];
  Wave& wave = waves_[at(c)];
  wave.centre = coordinate.default_value;
  if (model_.coordinates()[at(c)].state_idx < 0 || coordinate.held()) return;

  Random random = stream(options_.seed, Draw::motion, at(c));
  double amplitude = excursion(options_.motion, coordinate) * random.uniform(0.6, 1.0);
  wave.centre += random.uniform(-0.2, 0.2) * amplitude;
  if (coordinate.clamped) {
    const double width = coordinate.range_max - coordinate.range_min;
    const double low = coordinate.range_min + kMarginOfRange * width;
    const double high = coordinate.range_max - kMarginOfRange * width;
    amplitude = std::max(0.0, std::min(amplitude, 0.5 * (high - low)));
    wave.centre = std::max(low + amplitude, std::min(wave.centre, high - amplitude));
  }

  // The parts add up to the amplitude, so that the sum never leaves the range.
  switch (options_.motion) {
    case MotionKind::walk: {
      const double share = random.uniform(0.6, 0.9), phase = random.uniform(0.0, kTwoPi),
                   second = random.uniform(0.0, kTwoPi);
      wave.sines = {{share * amplitude, stride_hz_, phase},
                    {(1.0 - share) * amplitude, 2.0 * stride_hz_, second}};
      break;
    }
    case MotionKind::reach:
      wave.sines = {sine(0.6 * amplitude, 0.2, 0.4, random), sine(0.4 * amplitude, 0.4, 0.7, random)};
      break;
    case MotionKind::tai_chi:
      wave.sines = {sine(0.65 * amplitude, 0.05, 0.12, random), sine(0.35 * amplitude, 0.12, 0.25, random)};
      break;
    case MotionKind::mixed:
      wave.sines = {sine(0.5 * amplitude, 0.1, 0.25, random), sine(0.3 * amplitude, 0.25, 0.5, random),
                    sine(0.2 * amplitude, 0.5, 0.9, random)};
      break;
  }

  // Walking: the left side repeats the motion of the right side half a stride later, about the same centre.
  if (options_.motion == MotionKind::walk && coordinate.name.ends_with("_l")) {
    const int opposite =
        model_.description().find_coordinate(coordinate.name.substr(0, coordinate.name.size() - 2) + "_r");
    if (opposite >= 0 && opposite < c && !waves_[at(opposite)].sines.empty() && coordinate.clamped) {
      const auto& other = model_.description().coordinates[at(opposite)];
      if (other.range_min == coordinate.range_min && other.range_max == coordinate.range_max) {
        wave = waves_[at(opposite)];
        wave.sines[0].phase += 0.5 * kTwoPi;
      }
    }
  }
}

void Motion::draw_root(std::size_t which) {
  Random random = stream(options_.seed, Draw::root, which + 1);
  const auto waves = [&](double amplitude, double base_hz, Wave(&out)[3]) {
    for (auto& wave : out)
      wave.sines = options_.motion == MotionKind::walk
                       ? std::vector<Wave::Sine>{sine(amplitude, base_hz, base_hz, random)}
                       : std::vector<Wave::Sine>{sine(0.6 * amplitude, 0.5 * base_hz, base_hz, random),
                                                 sine(0.4 * amplitude, base_hz, 2.0 * base_hz, random)};
  };
  switch (options_.motion) {
    case MotionKind::walk:
      waves(0.03, stride_hz_, roots_[which].shift);
      waves(0.08, stride_hz_, roots_[which].sway);
      roots_[which].shift[1].sines[0].frequency_hz *= 2.0;  // up and down with every step
      break;
    case MotionKind::reach:
      waves(0.08, 0.3, roots_[which].shift);
      waves(0.12, 0.3, roots_[which].sway);
      break;
    case MotionKind::tai_chi:
      waves(0.20, 0.1, roots_[which].shift);
      waves(0.20, 0.1, roots_[which].sway);
      break;
    case MotionKind::mixed:
      waves(0.15, 0.3, roots_[which].shift);
      waves(0.25, 0.3, roots_[which].sway);
      break;
  }
}

Eigen::VectorXd Motion::state(double t_s) const {
  Eigen::VectorXd x = default_state_;
  for (int c = 0; c < model_.coordinate_count(); ++c)
    if (const int i = model_.coordinates()[at(c)].state_idx; i >= 0) {
      const auto& prescribed = model_.description().coordinates[at(c)].prescribed;
      x[i] = prescribed ? (*prescribed)(t_s).f : waves_[at(c)](t_s);
    }

  const double heading = kTwoPi * options_.full_turns * t_s / options_.duration_s;
  const Vector3d up = vertical(model_);
  const Matrix3d heading_rotation = math::axis_angle(up, heading);
  for (std::size_t r = 0; r < roots_.size(); ++r) {
    const auto& free = model_.free_joints()[r];
    const Matrix3d frame = model_.bodies()[at(free.body)].parent_from_joint.rotation;
    const Eigen::Quaterniond start(x[free.state_idx + 3], x[free.state_idx + 4], x[free.state_idx + 5],
                                   x[free.state_idx + 6]);
    const Matrix3d attitude = frame * start.toRotationMatrix();
    Vector3d shift, sway;
    for (int i = 0; i < 3; ++i) {
      shift[i] = roots_[r].shift[i](t_s);
      sway[i] = roots_[r].sway[i](t_s);
    }
    // On a circle about a point beside the start, facing along it: forward is the body's first axis.
    const Vector3d level = attitude.col(0) - up * up.dot(attitude.col(0));
    const Vector3d forward = level.norm() > 1e-6 ? Vector3d(level.normalized()) : up.unitOrthogonal();
    const Vector3d to_centre =
        (options_.full_turns >= 0.0 ? 1.0 : -1.0) * circle_radius_m_ * up.cross(forward);
    const Vector3d walked = to_centre - heading_rotation * to_centre;
    const Vector3d moved =
        walked + heading_rotation * (shift[0] * forward + shift[1] * up + shift[2] * forward.cross(up));
    x.segment<3>(free.state_idx) += frame.transpose() * moved;
    const Eigen::Quaterniond rotation(
        Matrix3d(frame.transpose() * heading_rotation * attitude * math::exp_so3(sway)));
    x.segment<4>(free.state_idx + 3) << rotation.w(), rotation.x(), rotation.y(), rotation.z();
    x.segment<4>(free.state_idx + 3).normalize();
  }
  return x;
}

}  // namespace kinemark::simulation::internal

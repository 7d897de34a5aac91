// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/marker_mounts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/internal/profile_errors.h"
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kFixed = 0.1 * 0.1;        // rad^2: bodies that markers fix no better say nothing of sensors
constexpr double kAsAPose = 0.035 * 0.035;  // rad^2, 2 deg: how well a subject stands as the model does
constexpr double kSensor = 0.02 * 0.02;     // rad^2, of a sensor before its noise is known
constexpr std::int64_t kLeastFrames = 10;
constexpr double kIndependent = 24.0;  // frames at most, and ...
constexpr double kAlike_s = 0.2;       // ... one in so long: skin follows the posture
constexpr double kLeastVariance = 1e-6;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

}  // namespace

std::vector<MarkedTurn> find_marked_turns(const Problem& problem, const data::Trajectories& markers,
                                          const Eigen::MatrixXd& states, const Eigen::VectorXd& information,
                                          const PosedSensors& posed,
                                          const std::vector<std::int64_t>& frames) {
  const auto& model = problem.model;
  model::Workspace w(model);
  SpeedCovariance covariance(problem);
  Eigen::Matrix3Xd y(3, model.marker_count());
  Eigen::VectorXd weight(model.marker_count());
  Eigen::MatrixXd K, A(3, model.speed_count());
  std::vector<MarkedTurn> out;
  for (const auto f : frames) {
    problem.observe(markers, f, y, weight);
    for (Eigen::Index m = 0; m < weight.size(); ++m) weight[m] = weight[m] > 0.0 ? information[m] : 0.0;
    model::kinematics(model, w, states.col(f));
    covariance.factor(w, weight);
    covariance.invert(K);
    for (const auto& sensor : posed.sensors) {
      const int body = model.body_of(sensor.body_idx);
      turning_jacobian(model, w, body, A);
      const Eigen::Matrix3d spread = A * K * A.transpose();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread, Eigen::EigenvaluesOnly);
      out.push_back({.world_from_body = w.rotation[at(body)], .variance = eigen.eigenvalues()[2]});
    }
  }
  return out;
}

MarkerMounts::MarkerMounts(const PosedSensors& posed, const data::Orientations& recording,
                           const std::vector<MarkedTurn>& turns, const std::vector<std::int64_t>& frames)
    : posed_(posed),
      sums_(posed.sensors.size()),
      independent_(std::clamp(static_cast<double>(recording.frames()) / recording.time.rate_hz / kAlike_s,
                              1.0, kIndependent)) {
  const Eigen::Matrix3d along = posed.up * posed.up.transpose();
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity() - along, turned = cross(posed.up);
  // Skin errs alike in all frames: their number makes a body that is held badly no better than a pose.
  const double fixed = posed.unplaced ? kFixed : kAsAPose;
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (std::size_t s = 0; s < sums_.size(); ++s) {
      const auto& turn = turns[i * sums_.size() + s];
      const auto column = posed.sensors[s].column;
      if (!(turn.variance < fixed) || !recording.present(frames[i], column)) continue;
      const double information = 1.0 / (kSensor + turn.variance);
      const Eigen::Matrix3d body = information * turn.world_from_body.transpose();
      const Eigen::Matrix3d sensor = posed.model_from_world * recording.rotation(frames[i], column);
      auto& sums = sums_[s];
      sums.along += body * along * sensor;
      sums.cosine += body * level * sensor;
      sums.sine += body * turned * sensor;
      sums.information += information;
      ++sums.frames;
    }
}

Eigen::Matrix3d MarkerMounts::Sums::value(double heading_rad) const {
  return along + std::cos(heading_rad) * cosine + std::sin(heading_rad) * sine;
}

bool MarkerMounts::by_markers(std::size_t sensor) const {
  return !posed_.by_model && sums_[sensor].frames >= kLeastFrames;
}

Eigen::Matrix3d MarkerMounts::body_from_sensor(std::size_t sensor, double heading_rad) const {
  return math::fit_rotation(sums_[sensor].value(heading_rad)).rotation;
}

double MarkerMounts::variance(std::size_t sensor) const { return 1.0 / sums_[sensor].information; }

/// Squared angles between sensors and bodies, each by its information.
double MarkerMounts::cost(double heading_rad) const {
  double sum = 0.0;
  for (std::size_t s = 0; s < sums_.size(); ++s) {
    const auto& sums = sums_[s];
    if (sums.frames == 0 || (!by_markers(s) && posed_.unplaced)) continue;
    const Eigen::Matrix3d value = sums.value(heading_rad);
    const Eigen::Matrix3d placed = by_markers(s)
                                       ? math::fit_rotation(value).rotation
                                       : internal::body_from_sensor(posed_, posed_.sensors[s], heading_rad);
    sum += 3.0 * sums.information - placed.cwiseProduct(value).sum();
  }
  return sum;
}

Result<Heading> MarkerMounts::find_heading() const {
  std::int64_t frames = 0;
  double numbers = 0.0;
  for (std::size_t s = 0; s < sums_.size(); ++s) {
    frames = std::max(frames, sums_[s].frames);
    numbers += static_cast<double>(3 * std::max<std::int64_t>(0, sums_[s].frames - (by_markers(s) ? 1 : 0)));
  }
  const double share = std::min(1.0, independent_ / static_cast<double>(std::max<std::int64_t>(1, frames)));
  return choose_heading([&](double rad) { return share * cost(rad); }, std::max(1.0, share * numbers),
                        kLeastVariance);
}

}  // namespace kinemark::motion::internal

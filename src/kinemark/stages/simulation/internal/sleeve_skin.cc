// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/sleeve_skin.h"

#include <cmath>
#include <cstdint>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/simulation/internal/limb_build.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Translation and turn of all LEDs of a segment as one body, over the slide of each by itself: six tenths of
/// the energy move them as one body, half to 80 % in those who measured it (Grimpampi et al. 2014, Barre et
/// al. 2013).
constexpr double kCommon = 0.7;

/// Rotation vectors from their mean rotation, less their mean: F x 3.
MatrixXd about_mean(const std::vector<Matrix3d>& rotations) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& rotation : rotations) sum += rotation;
  const Matrix3d mean = math::fit_rotation(sum).rotation;
  MatrixXd out(std::ssize(rotations), 3);
  for (std::size_t f = 0; f < rotations.size(); ++f)
    out.row(static_cast<Eigen::Index>(f)) = math::log_so3(mean.transpose() * rotations[f]).transpose();
  out.rowwise() -= out.colwise().mean().eval();
  return out;
}

}  // namespace

SleeveSkin::SleeveSkin(const SleeveOptions& options, std::span<const ArmPose> poses,
                       std::span<const Eigen::Matrix3Xd> x_in_segment) {
  if (options.skin_m == 0.0 || poses.empty()) return;
  std::vector<Matrix3d> elbow, shoulder;
  for (const auto& pose : poses) {
    elbow.emplace_back(pose.world_from_upper_arm.transpose() * pose.world_from_forearm);
    shoulder.push_back(pose.world_from_upper_arm);
  }
  posture_.resize(std::ssize(poses), 6);
  posture_ << about_mean(elbow), about_mean(shoulder);
  Random random(options.seed, static_cast<std::uint64_t>(LimbStream::skin));
  // The forearm's skin follows the elbow, the upper arm's the shoulder as well.
  const auto draw = [&](bool forearm) {
    MatrixXd out = MatrixXd::Zero(3, 6);
    for (Eigen::Index column = 0; column < (forearm ? 3 : 6); ++column)
      for (Eigen::Index row = 0; row < 3; ++row) out(row, column) = random.gaussian();
    return out;
  };
  for (const bool forearm : {false, true}) {
    const Eigen::Matrix3Xd& x = x_in_segment[forearm ? 1 : 0];
    const Vector3d mean = x.rowwise().mean();
    const double radius = std::sqrt((x.colwise() - mean).squaredNorm() / static_cast<double>(x.cols()));
    const MatrixXd moved = kCommon * draw(forearm), turned = kCommon / radius * draw(forearm);
    double squares = 0.0;
    for (const Vector3d position : x.colwise()) {
      by_rad_.emplace_back(draw(forearm) + moved - math::skew(position - mean) * turned);
      squares += (posture_ * by_rad_.back().transpose()).squaredNorm();
    }
    const double rms = std::sqrt(squares / static_cast<double>(std::ssize(poses) * x.cols()));
    for (std::size_t led = by_rad_.size() - at(x.cols()); led < by_rad_.size() && rms > 0.0; ++led)
      by_rad_[led] *= options.skin_m / rms;
  }
}

Vector3d SleeveSkin::slide(std::size_t frame, int led) const {
  if (posture_.size() == 0) return Vector3d::Zero();
  return by_rad_[at(led)] * posture_.row(static_cast<Eigen::Index>(frame)).transpose();
}

}  // namespace kinemark::simulation::internal

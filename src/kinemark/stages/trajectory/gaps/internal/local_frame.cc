// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/local_frame.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kinemark/math/rotation_fit.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kThinM = 0.005;  // a shape narrower than this about a line gives no rotation

}  // namespace

LocalFrame::LocalFrame(const Recording& recording, std::span<const Index> markers,
                       std::span<const double> sd_m, std::span<const Index> shape_frames)
    : recording_(&recording), markers_(markers.begin(), markers.end()) {
  const auto n = static_cast<Index>(markers_.size());
  weight_.setConstant(n, 1.0);
  if (n < 3 || shape_frames.empty()) {
    if (n > 0) weight_ /= static_cast<double>(n);
    return;
  }
  for (Index k = 0; k < n; ++k) {
    const double sd = sd_m[static_cast<std::size_t>(k)];
    weight_(k) = 1.0 / (sd * sd + 1e-6);
  }
  weight_ /= weight_.sum();
  const auto place_shape = [&](Index frame) {
    const Eigen::Vector3d c = centre(frame);
    for (Index k = 0; k < n; ++k)
      shape_.col(k) = recording_->x(markers_[static_cast<std::size_t>(k)], frame) - c;
  };
  shape_.resize(3, n);
  place_shape(shape_frames[shape_frames.size() / 2]);
  has_rotation_ = true;
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, n);
    for (const Index frame : shape_frames) {
      const LocalPose p = at(frame);
      for (Index k = 0; k < n; ++k)
        sum.col(k) += p.R.transpose() * (recording_->x(markers_[static_cast<std::size_t>(k)], frame) - p.c);
    }
    shape_ = sum / static_cast<double>(shape_frames.size());
    shape_.colwise() -= Eigen::Vector3d(shape_ * weight_);
  }
  const Eigen::Matrix3d spread = shape_ * weight_.asDiagonal() * shape_.transpose();
  has_rotation_ =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues()(1) >
      kThinM * kThinM;
}

Eigen::Vector3d LocalFrame::centre(Index frame) const {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k)
    c += weight_(static_cast<Index>(k)) * recording_->x(markers_[k], frame);
  return c;
}

LocalPose LocalFrame::at(Index frame) const {
  LocalPose p;
  p.c = centre(frame);
  if (!has_rotation_) return p;
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    const auto i = static_cast<Index>(k);
    S += weight_(i) * (recording_->x(markers_[k], frame) - p.c) * shape_.col(i).transpose();
  }
  p.R = math::fit_rotation(S).rotation;
  return p;
}

}  // namespace kinemark::trajectory::internal

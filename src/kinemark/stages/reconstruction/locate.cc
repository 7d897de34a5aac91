// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/locate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "kinemark/camera/noise.h"
#include "kinemark/camera/response.h"
#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/scale_free.h"

namespace kinemark::reconstruction {
namespace {

/// Sum over observations of J'J, J'r and r'r at a point.
struct Normal {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double chi2 = 0.0, farthest_spot = 0.0;
  bool in_front = true;
};

Normal linearize(const data::Rig& rig, std::span<const CountObservation> observations,
                 const Eigen::Vector3d& x) {
  Normal out;
  for (const auto& s : observations) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(s.camera)];
    const auto response = camera::respond(camera, x);
    // A channel with neither reading nor share adds a residual of 0.
    const auto left = math::eliminate_scale(s.keep.cwiseProduct(s.counts - camera.detector.offset_counts),
                                            s.keep.cwiseProduct(response.phi));
    const Eigen::Matrix3d j = -left.scale * (left.basis * s.keep.asDiagonal() * response.d_point);
    out.h += j.transpose() * j / s.variance;
    out.g += j.transpose() * left.residual / s.variance;
    out.chi2 += left.residual.squaredNorm() / s.variance;
    out.farthest_spot = std::max(out.farthest_spot, response.spot.cwiseAbs().maxCoeff());
    out.in_front = out.in_front && response.in_front;
  }
  return out;
}

}  // namespace

double strength_of(const data::Camera& camera, const CountObservation& read,
                   const Eigen::Vector3d& x_in_world) {
  return math::eliminate_scale(read.keep.cwiseProduct(read.counts - camera.detector.offset_counts),
                               read.keep.cwiseProduct(camera::respond(camera, x_in_world).phi))
      .scale;
}

std::optional<Located> locate(const data::Rig& rig, std::span<const CountObservation> observations,
                              const Eigen::Vector3d& start) {
  constexpr int kSteps = 30;
  constexpr double kLongestStep_m = 0.15, kSettled_m = 2e-7, kGone_m = 1e3;
  if (observations.size() < 2 || !start.allFinite()) return std::nullopt;
  Eigen::Vector3d x = start;
  for (int i = 0; i < kSteps; ++i) {
    const Normal at = linearize(rig, observations, x);
    if (!at.in_front || !at.h.allFinite()) return std::nullopt;
    // A ridge of 1 / (100 m)^2: negligible where cameras see the point, and no division by zero where none
    // does.
    Eigen::Vector3d step = -(at.h + 1e-4 * Eigen::Matrix3d::Identity()).ldlt().solve(at.g);
    if (!step.allFinite()) return std::nullopt;
    const double length = step.norm();
    if (length < kSettled_m)
      return Located{
          .x_in_world = x + step, .information = at.h, .chi2 = at.chi2, .farthest_spot = at.farthest_spot};
    if (length > kLongestStep_m) step *= kLongestStep_m / length;
    x += step;
    if (x.norm() > kGone_m) return std::nullopt;
  }
  return std::nullopt;
}

Eigen::Vector3d middle_of_view(const data::Rig& rig) {
  Eigen::Matrix3d a = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const auto& camera : rig.cameras) {
    const Eigen::Vector3d axis = camera.cam_from_world.rotation.row(2);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    a += across;
    b += across * camera.centre_in_world();
  }
  return a.ldlt().solve(b);
}

Eigen::Matrix3d cramer_rao(const data::Rig& rig, const Eigen::Vector3d& x_in_world,
                           std::span<const double> strength) {
  check(strength.size() == rig.cameras.size(), "one strength per camera");
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int seen = 0;
  for (std::size_t c = 0; c < strength.size(); ++c) {
    if (!(strength[c] > 0.0)) continue;
    ++seen;
    const auto response = camera::respond(rig.cameras[c], x_in_world);
    const Eigen::Vector4d counts = strength[c] * response.phi + rig.cameras[c].detector.offset_counts;
    // With channels of unequal noise the strength is eliminated in the metric of that noise.
    Eigen::Matrix4d w = Eigen::Matrix4d::Zero();
    for (int k = 0; k < 4; ++k) w(k, k) = 1.0 / camera::conversion_variance(rig.electronics, counts[k]);
    const Eigen::Vector4d wp = w * response.phi;
    const Eigen::Matrix4d metric = w - wp * wp.transpose() / response.phi.dot(wp);
    const Eigen::Matrix<double, 4, 3> j = strength[c] * response.d_point;
    information += j.transpose() * metric * j;
  }
  if (seen < 2) return Eigen::Matrix3d::Constant(kNaN);
  return information.inverse();
}

Eigen::Matrix<double, 3, Eigen::Dynamic> by_parameters(const data::Rig& rig,
                                                       const Eigen::Vector3d& x_in_world,
                                                       std::span<const double> strength,
                                                       std::span<const double> weight) {
  check(strength.size() == rig.cameras.size() && weight.size() == rig.cameras.size(),
        "one strength and weight per camera");
  Eigen::Matrix<double, 3, Eigen::Dynamic> out =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, rig.parameter_count());
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 4, Eigen::Dynamic> by_camera;
  for (int c = 0; c < rig.camera_count(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    if (!(weight[at] > 0.0)) continue;
    const auto& camera = rig.cameras[at];
    const data::ParameterLayout layout(camera);
    by_camera.resize(4, layout.count);
    const auto response = camera::respond(camera, x_in_world, by_camera);
    // Derivative by the offset, from counts = strength * phi + offset.
    by_camera.middleCols<4>(layout.offset) = Eigen::Matrix4d::Identity() / strength[at];
    const auto free = math::eliminate_scale(response.phi, response.phi);
    const Eigen::Matrix<double, 3, 3> j = free.basis * response.d_point;
    h += weight[at] * j.transpose() * j;
    out.middleCols(rig.first_parameter(c), layout.count) =
        -weight[at] * j.transpose() * (free.basis * by_camera);
  }
  return (h + 1e-9 * Eigen::Matrix3d::Identity()).inverse() * out;
}

}  // namespace kinemark::reconstruction

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/projection.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinemark/camera/distortion.h"
#include "kinemark/camera/monomials.h"
#include "kinemark/core/check.h"

namespace kinemark::camera {
namespace {

using data::ParameterLayout;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Eigen::Map<const Eigen::VectorXd> terms(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// Position on the real sheet of a spot whose position on an ideal one is `ideal`.
struct Warped {
  Vector2d image;
  Matrix2d d_ideal;
};

Warped warp(const data::Detector& detector, const Vector2d& ideal, const Monomials& basis) {
  const auto wx = terms(detector.warp_x), wy = terms(detector.warp_y);
  Warped out;
  out.image << ideal.x() + wx.dot(basis.value()), ideal.y() + wy.dot(basis.value());
  out.d_ideal << 1.0 + wx.dot(basis.d_x()), wx.dot(basis.d_y()), wy.dot(basis.d_x()),
      1.0 + wy.dot(basis.d_y());
  return out;
}

Projection project_into(const data::Camera& camera, const Vector3d& x_in_world, ImageJacobian* d_parameters) {
  Projection out;
  const Eigen::Matrix3d& rotation = camera.cam_from_world.rotation;
  out.x_in_cam = camera.cam_from_world * x_in_world;
  out.in_front = out.x_in_cam.z() > 0.0;
  const double inverse_z = 1.0 / out.x_in_cam.z();
  const Vector2d slopes = out.x_in_cam.head<2>() * inverse_z;
  Eigen::Matrix<double, 2, 3> d_slopes;  // by x_in_cam
  d_slopes << inverse_z, 0.0, -slopes.x() * inverse_z, 0.0, inverse_z, -slopes.y() * inverse_z;

  const Distorted lens = distort(camera.distortion, slopes);
  const Vector2d scale(camera.focal, camera.focal * camera.aspect);
  const Vector2d ideal = camera.principal_point + scale.cwiseProduct(lens.slopes);
  const bool lateral = camera.kind == data::CameraKind::lateral_effect;
  const Monomials basis(ideal.x(), ideal.y(), 2, lateral ? camera.detector.warp_degree : 1);
  const Warped sheet =
      lateral && basis.size() > 0 ? warp(camera.detector, ideal, basis) : Warped{ideal, Matrix2d::Identity()};
  out.image = sheet.image;
  out.on_sheet = !lateral || out.image.cwiseAbs().maxCoeff() < camera.detector.edge;

  const Matrix2d d_lens = sheet.d_ideal * scale.asDiagonal();
  const Eigen::Matrix<double, 2, 3> d_cam = d_lens * lens.d_slopes * d_slopes;
  out.d_point = d_cam * rotation;
  if (d_parameters == nullptr) return out;

  const ParameterLayout layout(camera);
  check(d_parameters->cols() == layout.crosstalk,
        "project() needs a column per parameter that moves the image");
  d_parameters->setZero();
  // x_in_cam = exp(w) R (X - C): derivative by w is -[x_in_cam]x, by C it is -R.
  for (int i = 0; i < 3; ++i)
    d_parameters->col(ParameterLayout::rotation + i) = d_cam * Vector3d::Unit(i).cross(out.x_in_cam);
  d_parameters->middleCols<3>(ParameterLayout::centre) = -out.d_point;
  d_parameters->col(ParameterLayout::focal) =
      sheet.d_ideal * Vector2d(lens.slopes.x(), camera.aspect * lens.slopes.y());
  d_parameters->col(ParameterLayout::aspect) = sheet.d_ideal * Vector2d(0.0, camera.focal * lens.slopes.y());
  d_parameters->middleCols<2>(ParameterLayout::principal) = sheet.d_ideal;
  d_parameters->middleCols<5>(ParameterLayout::distortion) = d_lens * lens.d_parameters;
  if (layout.warp_terms > 0) {
    d_parameters->row(0).segment(ParameterLayout::warp_x, layout.warp_terms) = basis.value().transpose();
    d_parameters->row(1).segment(layout.warp_y, layout.warp_terms) = basis.value().transpose();
  }
  return out;
}

/// The ideal spot position that the warp maps to image.
std::optional<Vector2d> unwarp(const data::Detector& detector, const Vector2d& image) {
  Vector2d ideal = image;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Warped at = warp(detector, ideal, Monomials(ideal.x(), ideal.y(), 2, detector.warp_degree));
    const Vector2d miss = at.image - image;
    if (!(at.d_ideal.determinant() > 0.0)) return std::nullopt;
    if (miss.norm() <= 1e-14 * (1.0 + image.norm())) return ideal;
    ideal -= at.d_ideal.inverse() * miss;
  }
  return std::nullopt;
}

}  // namespace

Projection project(const data::Camera& camera, const Vector3d& x_in_world) {
  return project_into(camera, x_in_world, nullptr);
}

Projection project(const data::Camera& camera, const Vector3d& x_in_world, ImageJacobian d_parameters) {
  return project_into(camera, x_in_world, &d_parameters);
}

std::optional<Ray> unproject(const data::Camera& camera, const Vector2d& image) {
  if (!image.allFinite()) return std::nullopt;
  Vector2d ideal = image;
  if (camera.kind == data::CameraKind::lateral_effect && camera.detector.warp_terms() > 0) {
    const auto unwarped = unwarp(camera.detector, image);
    if (!unwarped) return std::nullopt;
    ideal = *unwarped;
  }
  const Vector2d scale(camera.focal, camera.focal * camera.aspect);
  const auto slopes = undistort(camera.distortion, (ideal - camera.principal_point).cwiseQuotient(scale));
  if (!slopes) return std::nullopt;
  const Vector3d direction =
      camera.cam_from_world.rotation.transpose() * Vector3d(slopes->x(), slopes->y(), 1.0);
  return Ray{camera.centre_in_world(), direction.normalized()};
}

}  // namespace kinemark::camera

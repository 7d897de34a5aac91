// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/response.h"

#include <algorithm>

#include "kinemark/camera/monomials.h"
#include "kinemark/camera/projection.h"
#include "kinemark/camera/shares.h"
#include "kinemark/core/check.h"

namespace kinemark::camera {
namespace {

using data::ParameterLayout;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Channels from electrodes: row k of the result holds the shares of the electrodes in channel k.
Matrix4d mixing(const data::Detector& detector) {
  return detector.gain.asDiagonal() * (Matrix4d::Identity() + detector.crosstalk).transpose();
}

SpotResponse through(const Matrix4d& mix, const Shares& s) { return {mix * s.share, mix * s.d_spot}; }

/// Derivatives by the parameters after the spot: crosstalk, generic shares and gain.
void fill_channels(const data::Detector& detector, const ParameterLayout& layout, const Shares& s,
                   const Vector2d& spot, const Matrix4d& mix, ResponseJacobian d_parameters) {
  int column = layout.crosstalk;
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 4; ++k)
      if (j != k) d_parameters(k, column++) = detector.gain[k] * s.share[j];
  for (int k = 0; k < 4; ++k) d_parameters(k, layout.gain + k) = mix.row(k).dot(s.share) / detector.gain[k];
  if (detector.kind != data::DetectorKind::generic) return;
  const double edge = detector.edge;
  const Monomials basis(std::clamp(spot.x(), -edge, edge), std::clamp(spot.y(), -edge, edge), 0,
                        detector.generic_degree);
  for (int k = 0; k < 3; ++k)
    d_parameters.middleCols(layout.generic + k * basis.size(), basis.size()) =
        (mix.col(k) - mix.col(3)) * basis.value().transpose();
}

}  // namespace

SpotResponse respond_at(const data::Detector& detector, const Vector2d& spot) {
  return through(mixing(detector), shares(detector, spot.x(), spot.y()));
}

Response respond(const data::Camera& camera, const Vector3d& x_in_world) {
  check(camera.kind == data::CameraKind::lateral_effect, "respond() needs a lateral-effect camera");
  const Projection seen = project(camera, x_in_world);
  const SpotResponse at = respond_at(camera.detector, seen.image);
  return {at.phi, at.d_spot * seen.d_point, seen.image, seen.in_front, seen.on_sheet};
}

Response respond(const data::Camera& camera, const Vector3d& x_in_world, ResponseJacobian d_parameters) {
  check(camera.kind == data::CameraKind::lateral_effect, "respond() needs a lateral-effect camera");
  const ParameterLayout layout(camera);
  check(d_parameters.cols() == layout.count, "respond() needs one column per parameter of the camera");
  // Parameters up to the warp move the spot; those after it change the response of the channels to the spot.
  constexpr int kMostMoving = ParameterLayout::warp_x + 2 * Monomials::kMost;
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, kMostMoving> d_image(2, layout.crosstalk);
  const Projection seen = project(camera, x_in_world, d_image);
  const Matrix4d mix = mixing(camera.detector);
  const Shares s = shares(camera.detector, seen.image.x(), seen.image.y());
  const SpotResponse at = through(mix, s);
  d_parameters.setZero();
  d_parameters.leftCols(layout.crosstalk) = at.d_spot * d_image;
  fill_channels(camera.detector, layout, s, seen.image, mix, d_parameters);
  return {at.phi, at.d_spot * seen.d_point, seen.image, seen.in_front, seen.on_sheet};
}

}  // namespace kinemark::camera

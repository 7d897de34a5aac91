// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/camera_observations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

#include "kinemark/camera/projection.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

/// A pinhole camera at a position, looking at the origin, with 1000 px per unit slope.
data::Camera camera_at(const Vector3d& position) {
  data::Camera camera;
  camera.kind = data::CameraKind::pinhole;
  camera.focal = 1000.0;
  const Vector3d z = -position.normalized(), x = Vector3d::UnitY().cross(z).normalized(), y = z.cross(x);
  camera.cam_from_world.rotation.row(0) = x.transpose();
  camera.cam_from_world.rotation.row(1) = y.transpose();
  camera.cam_from_world.rotation.row(2) = z.transpose();
  camera.cam_from_world.translation = -camera.cam_from_world.rotation * position;
  return camera;
}

struct Stereo {
  model::Model model = model::Model::compile(testing_body::description()).value();
  data::Trajectories markers;
  data::ImageTracks tracks;

  explicit Stereo(std::int64_t frames) {
    const auto exact = testing_body::record(model, frames);
    markers = testing_body::record(model, frames, 0.003, 5);
    tracks.names = exact.names;
    tracks.time = exact.time;
    tracks.cameras = {camera_at({3.0, 0.5, 2.0}), camera_at({3.0, 0.5, -2.0})};
    tracks.noise_sd = {0.5, 0.5};
    Random random(2, 2);
    for (std::int64_t f = 0; f < frames; ++f)
      for (const auto& camera : tracks.cameras)
        for (std::int64_t m = 0; m < exact.markers(); ++m) {
          const auto seen = camera::project(camera, exact.x(f, m));
          for (int axis = 0; axis < 2; ++axis)
            tracks.image.push_back(seen.image[axis] + 0.5 * random.gaussian());
        }
  }
  /// The second camera goes dark; with it everything that needs two.
  void lose_camera(std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first; f < last; ++f)
      for (std::size_t m = 0; m < tracks.names.size(); ++m) {
        tracks.image[tracks.index(f, 1, m)] = tracks.image[tracks.index(f, 1, m) + 1] = kNaN;
        markers.set_missing(f, static_cast<std::int64_t>(m));
      }
  }
};

TEST(CameraObservations, DescentIsTheSlopeOfTheCost) {
  const Stereo stereo(1);
  std::vector<int> column;
  for (int m = 0; m < 14; ++m) column.push_back(m);
  const CameraObservations observations(stereo.tracks, column, 0, 3.0);
  Eigen::Matrix3Xd p(3, 14);
  for (int m = 0; m < 14; ++m) p.col(m) = stereo.markers.x(0, m);  // some beyond 3 SD of the image
  MarkerInformation out, moved;
  observations.linearize(0, p, out);
  EXPECT_GT(out.cost, 1.0);
  for (int m = 0; m < 14; ++m)
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-6;
      Eigen::Matrix3Xd q = p;
      q(axis, m) += h;
      observations.linearize(0, q, moved);
      const double up = moved.cost;
      q(axis, m) -= 2 * h;
      observations.linearize(0, q, moved);
      EXPECT_NEAR(out.descent(axis, m), -(up - moved.cost) / (2 * h),
                  1e-3 * (1.0 + std::abs(out.descent(axis, m))));
    }
}

TEST(CameraObservations, OneCameraKnowsNothingOfDepth) {
  Stereo stereo(1);
  stereo.lose_camera(0, 1);
  const CameraObservations observations(stereo.tracks, {3}, 0, 0.0);
  Eigen::Matrix3Xd p(3, 1);
  p.col(0) = Vector3d(0.1, 0.2, 0.0);
  MarkerInformation out;
  observations.linearize(0, p, out);
  const Vector3d ray = (p.col(0) - Vector3d(3.0, 0.5, 2.0)).normalized();
  EXPECT_LT((out.full[0] * ray).norm(), 1e-9 * out.full[0].norm());
  EXPECT_EQ(out.weight[0], 0.0);
}

TEST(CameraObservations, WithoutAColumnAMarkerIsUnseen) {
  const Stereo stereo(1);
  const CameraObservations observations(stereo.tracks, {-1}, 0, 0.0);
  MarkerInformation out;
  observations.linearize(0, Eigen::Matrix3Xd::Zero(3, 1), out);
  EXPECT_EQ(out.cost, 0.0);
  EXPECT_TRUE(out.full[0].isZero(0.0));
}

TEST(CameraObservations, OneCameraCarriesTheBodyThroughAGap) {
  Stereo stereo(240);
  stereo.lose_camera(80, 160);
  const auto with = smooth_images(stereo.model, stereo.tracks, stereo.markers).value();
  auto dropped = stereo.tracks;
  for (std::int64_t f = 80; f < 160; ++f)
    for (std::size_t m = 0; m < dropped.names.size(); ++m)
      dropped.image[dropped.index(f, 0, m)] = dropped.image[dropped.index(f, 0, m) + 1] = kNaN;
  const auto without = smooth_images(stereo.model, dropped, stereo.markers).value();
  double with_squares = 0.0, without_squares = 0.0, z = 0.0;
  int count = 0;
  for (std::int64_t f = 90; f < 150; ++f) {
    const auto truth = testing_body::coordinates(stereo.model, f);
    for (int c = 6; c < 12; ++c, ++count) {
      const auto i = with.motion.index(f, c);
      with_squares += std::pow(with.motion.q[i] - truth[c], 2);
      without_squares += std::pow(without.motion.q[i] - truth[c], 2);
      z += std::pow((with.motion.q[i] - truth[c]) / with.motion.q_sd[i], 2);
    }
  }
  EXPECT_GT(without_squares, 4.0 * with_squares);
  EXPECT_LT(std::sqrt(z / count), 1.6);
  EXPECT_GT(with.motion.q_sd[with.motion.index(120, 9)], with.motion.q_sd[with.motion.index(30, 9)]);
}

TEST(CameraObservations, BadInputIsReportedInASentence) {
  Stereo stereo(20);
  auto wrong = stereo.tracks;
  wrong.noise_sd[0] = -1.0;
  EXPECT_THAT(smooth_images(stereo.model, wrong, stereo.markers).error().message, HasSubstr("noise of -1"));
  wrong = stereo.tracks;
  wrong.time.rate_hz = 50.0;
  EXPECT_THAT(smooth_images(stereo.model, wrong, stereo.markers).error().message, HasSubstr("at 50 Hz"));
  wrong = stereo.tracks;
  for (auto& name : wrong.names) name += "x";
  EXPECT_THAT(smooth_images(stereo.model, wrong, stereo.markers).error().message,
              HasSubstr("no marker in common"));
}

}  // namespace
}  // namespace kinemark::motion

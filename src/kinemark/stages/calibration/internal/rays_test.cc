// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/internal/rays.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "kinemark/camera/response.h"
#include "kinemark/core/random.h"
#include "support/lateral_rig.h"

namespace kinemark::calibration::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
namespace ts = testing_support;

const Vector3d kPoint(0.12, -0.2, 0.15);

std::vector<camera::Ray> rays_to(const Vector3d& x, int count) {
  Random random(3, 1);
  std::vector<camera::Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double a = random.uniform(-2.0, 2.0), b = random.uniform(-2.0, 2.0), c = random.uniform(1.0, 3.0);
    const Vector3d origin(a, b, c);
    rays.push_back({origin, (x - origin).normalized()});
  }
  return rays;
}

TEST(FindSpot, IsWhereTheReadingsComeFromWhateverTheLight) {
  for (const auto kind : {data::DetectorKind::tetra_lateral, data::DetectorKind::duo_lateral,
                          data::DetectorKind::pin_cushion}) {
    auto detector = ts::real_rig(4).cameras[0].detector;  // warped, with gains of its own
    detector.kind = kind;
    for (const double x : {-0.8, -0.3, 0.0, 0.5, 0.85})
      for (const double y : {-0.7, 0.1, 0.8})
        for (const double light : {1.0, 2500.0}) {
          const Vector2d spot(x, y);
          const auto found = find_spot(detector, light * camera::respond_at(detector, spot).phi);
          ASSERT_TRUE(found) << to_string(kind);
          EXPECT_LT((*found - spot).norm(), 1e-7) << to_string(kind) << " " << spot.transpose();
        }
  }
}

TEST(FindSpot, DarkAndSenselessReadingsHaveNone) {
  const auto detector = ts::ideal_rig().cameras[0].detector;
  EXPECT_FALSE(find_spot(detector, Vector4d::Zero()));
  EXPECT_FALSE(find_spot(detector, Vector4d::Constant(-1.0)));
  EXPECT_FALSE(find_spot(detector, Vector4d(1.0, 1.0, std::nan(""), 1.0)));
}

TEST(FindSpot, ReadingsOfNoSpotEndOnTheSheet) {
  const auto detector = ts::ideal_rig().cameras[0].detector;
  for (int channel = 0; channel < 4; ++channel) {
    const auto spot = find_spot(detector, Vector4d::Unit(channel));
    if (spot) {
      EXPECT_LE(spot->cwiseAbs().maxCoeff(), detector.edge) << channel;
    }
  }
}

TEST(SightLine, GoesFromTheLensThroughThePoint) {
  const auto rig = ts::real_rig(5);
  for (const auto& camera : rig.cameras) {
    const auto ray = line_of_sight(camera, ts::mean_counts(camera, kPoint));
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->origin_in_world, camera.centre_in_world());
    EXPECT_NEAR(ray->direction_in_world.norm(), 1.0, 1e-12);
    const Vector3d to_point = kPoint - ray->origin_in_world;
    EXPECT_LT(to_point.cross(ray->direction_in_world).norm(), 1e-6);
    EXPECT_GT(to_point.dot(ray->direction_in_world), 0.0) << "away from the camera";
    EXPECT_FALSE(line_of_sight(camera, camera.detector.offset_counts)) << "offsets alone are dark";
  }
}

TEST(SightLine, TwoOfThemMeetAtThePoint) {
  const auto rig = ts::real_rig(6);
  std::vector<camera::Ray> rays;
  for (const auto& camera : rig.cameras)
    rays.push_back(line_of_sight(camera, ts::mean_counts(camera, kPoint)).value());
  EXPECT_LT((meet(rays).value() - kPoint).norm(), 1e-6);
}

TEST(Meet, PerfectRaysMeetInTheirPoint) {
  for (const int count : {2, 3, 12}) {
    const auto x = meet(rays_to(kPoint, count));
    ASSERT_TRUE(x) << count;
    EXPECT_LT((*x - kPoint).norm(), 1e-10) << count;
  }
}

TEST(Meet, SkewRaysMeetHalfway) {
  const std::vector<camera::Ray> skew{{Vector3d(0, 0, 0), Vector3d::UnitX()},
                                      {Vector3d(0.3, -1, 0.02), Vector3d::UnitY()}};
  EXPECT_LT((meet(skew).value() - Vector3d(0.3, 0.0, 0.01)).norm(), 1e-12);
}

TEST(Meet, MovesWithTheLab) {
  auto rays = rays_to(kPoint, 4);
  rays[0].origin_in_world.z() += 0.05;  // they do not meet any more
  const Vector3d before = meet(rays).value();
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Vector3d shift(0.4, 3.0, -1.0);
  for (auto& ray : rays) ray = {rotation * ray.origin_in_world + shift, rotation * ray.direction_in_world};
  EXPECT_LT((meet(rays).value() - (rotation * before + shift)).norm(), 1e-10);
}

TEST(Meet, OneRayAndParallelOnesHaveNoPoint) {
  EXPECT_FALSE(meet({}));
  EXPECT_FALSE(meet(rays_to(kPoint, 1)));
  std::vector<camera::Ray> parallel(5, {Vector3d::Zero(), Vector3d::UnitZ()});
  for (int i = 0; i < 5; ++i) parallel[static_cast<std::size_t>(i)].origin_in_world.x() = 0.1 * i;
  EXPECT_FALSE(meet(parallel));
  parallel[0].direction_in_world = Vector3d(0.1, 0.0, 1.0).normalized();
  EXPECT_TRUE(meet(parallel)) << "one that crosses them is enough";
}

}  // namespace
}  // namespace kinemark::calibration::internal

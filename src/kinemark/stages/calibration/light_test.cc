// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/lateral_rig.h"

namespace kinemark::calibration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
namespace ts = testing_support;

/// Three LEDs in poses that turn and wander; cameras of different constants.
struct Shown {
  data::Rig rig = ts::real_rig(8);
  StillPoses poses;
  std::vector<math::SE3> world_from_tree;

  /// @param with_tree  directions turn with the tree; else they stay in the room
  Shown(int count, bool with_tree, double first = 20000.0, double second = 24000.0) {
    const std::vector<double> light{0.9, 1.0, 1.1};
    const Vector3d direction = Vector3d(0.1, 0.2, 1.0).normalized();
    poses.tree = {{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.0, 0.15}};
    poses.cameras = 2;
    Random random(3, 3);
    for (int p = 0; p < count; ++p) {
      math::SE3 pose;
      pose.rotation = Eigen::AngleAxisd(random.uniform(-0.6, 0.6), Vector3d::UnitY()).toRotationMatrix() *
                      Eigen::AngleAxisd(random.uniform(-0.4, 0.4), Vector3d::UnitX()).toRotationMatrix();
      pose.translation << random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3);
      world_from_tree.push_back(pose);
      for (std::size_t l = 0; l < 3; ++l)
        for (std::size_t c = 0; c < 2; ++c) {
          const auto& camera = rig.cameras[c];
          const Vector3d x = pose * poses.tree[l], to = camera.centre_in_world() - x;
          const Vector3d n = with_tree ? Vector3d(pose.rotation * direction) : direction;
          const double d = to.norm(), cosine = n.dot(to) / d * (camera.cam_from_world * x).z() / d;
          const double strength = light[l] * (c == 0 ? first : second) * cosine / (d * d);
          const Vector4d counts = strength * camera::respond(camera, x).phi + camera.detector.offset_counts;
          poses.observations.push_back(
              {counts + 0.05 * Vector4d::NullaryExpr([&] { return random.gaussian(); }), 0.0025});
        }
    }
  }
};

TEST(LightOfCalibration, ConstantsOfTheCamerasWhicheverWayTheLedsPoint) {
  // Directions that stay in the room are seen from nearly the same side in all poses: constants part from
  // them weakly.
  for (const bool with_tree : {true, false}) {
    Shown shown(80, with_tree);
    find_light_counts(shown.poses, shown.world_from_tree, shown.rig);
    const double within = with_tree ? 0.001 : 0.02;
    EXPECT_NEAR(shown.rig.cameras[0].detector.light_counts, 20000.0, within * 20000.0) << with_tree;
    EXPECT_NEAR(shown.rig.cameras[1].detector.light_counts, 24000.0, within * 24000.0) << with_tree;
  }
}

TEST(LightOfCalibration, PosesThatAreNotKnownDoNotServe) {
  Shown shown(40, true);
  shown.world_from_tree[3].translation.setConstant(std::nan(""));
  shown.poses.observations[7] = {};
  find_light_counts(shown.poses, shown.world_from_tree, shown.rig);
  EXPECT_NEAR(shown.rig.cameras[0].detector.light_counts, 20000.0, 40.0);
}

TEST(LightOfCalibration, StaysUnknownWithTooFewSights) {
  Shown shown(3, true);
  find_light_counts(shown.poses, shown.world_from_tree, shown.rig);
  EXPECT_TRUE(std::isnan(shown.rig.cameras[0].detector.light_counts));
}

}  // namespace
}  // namespace kinemark::calibration

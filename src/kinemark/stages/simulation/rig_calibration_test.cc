// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_calibration.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/camera/parameters.h"
#include "kinemark/camera/projection.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector4d;
using testing::HasSubstr;

const PhysicalRig& rig() {
  static const PhysicalRig drawn = draw_rig({.seed = 6}).value();
  return drawn;
}

TEST(Grid, HangsBeforeEachCamera) {
  const auto grid = record_grid(rig(), {.samples = 4}).value();
  ASSERT_EQ(grid.counts.size(), 2U);
  EXPECT_NEAR(grid.spacing_m, 1.0 / 14.0, 1e-15);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& counts = grid.counts[c];
    EXPECT_TRUE(counts.validate()) << counts.validate().error().message;
    EXPECT_EQ(counts.led_count(), 225);
    EXPECT_EQ(counts.cameras[0], rig().rig.cameras[c].name);
    EXPECT_EQ(counts.leds[3 * 15 + 4], "3,4");
    // Nominally node (i, j) is at (i - 7, j - 7) spacings; hands miss that by millimetres.
    for (int i : {0, 7, 14})
      for (int j : {0, 14}) {
        const Eigen::Vector3d off = grid.x_in_cam[c].col(i * 15 + j) -
                                    Eigen::Vector3d((i - 7) * grid.spacing_m, (j - 7) * grid.spacing_m, 3.0);
        EXPECT_LT(off.head<2>().norm(), 8e-3);
        EXPECT_LT(std::abs(off.z()), 25e-3);
      }
    // To the camera's right the +x electrode gets more, below it +y does.
    EXPECT_GT(counts.at(0, 14 * 15 + 7, 0)[0], 3.0 * counts.at(0, 14 * 15 + 7, 0)[1]);
    EXPECT_GT(counts.at(0, 7 * 15 + 14, 0)[2], 3.0 * counts.at(0, 7 * 15 + 14, 0)[3]);
  }
  // One board: relative positions of LEDs are the same before both cameras, whatever its pose.
  const auto distance = [&grid](std::size_t c) {
    return (grid.x_in_cam[c].col(0) - grid.x_in_cam[c].col(224)).norm();
  };
  EXPECT_NEAR(distance(0), distance(1), 1e-5);
}

TEST(Grid, SamplesScatterAroundTheExpectation) {
  const auto grid = record_grid(rig(), {.samples = 400}).value();
  const auto& camera = rig().rig.cameras[0];
  const int node = 8 * 15 + 5;
  const LedState led{.x_in_world = camera.cam_from_world.inverse() * grid.x_in_cam[0].col(node),
                     .normal = -camera.cam_from_world.rotation.row(2).transpose()};
  Vector4d mean = Vector4d::Zero();
  for (std::int64_t f = 0; f < 400; ++f) mean += grid.counts[0].at(f, node, 0) / 400.0;
  EXPECT_LT((mean - expected_counts(rig(), 0, led).counts).cwiseAbs().maxCoeff(), 0.25);
}

TEST(Grid, RefusesOptionsOutOfRange) {
  EXPECT_THAT(record_grid(rig(), {.nodes = 14}).error().message, HasSubstr("odd number"));
  EXPECT_THAT(record_grid(rig(), {.samples = 0}).error().message, HasSubstr("0 samples"));
  EXPECT_THAT(record_grid(rig(), {.side_m = -1.0}).error().message, HasSubstr("-1 m"));
  EXPECT_THAT(record_grid(rig(), {.tilt_sd_deg = NAN}).error().message, HasSubstr("nan"));
}

TEST(TreePoses, AreInSightAndHeldStill) {
  const auto out = record_tree_poses(rig(), {.poses = 12, .frames_per_pose = 5}).value();
  EXPECT_TRUE(out.counts.validate());
  EXPECT_EQ(out.counts.frames(), 60);
  ASSERT_EQ(out.leds_in_world.size(), 12U);
  for (std::size_t n = 0; n < 12; ++n)
    for (int c = 0; c < 2; ++c)
      for (int l = 0; l < 3; ++l) {
        const auto& camera = rig().rig.cameras[static_cast<std::size_t>(c)];
        const auto smooth = camera::with_warp_degree(camera, 0);
        EXPECT_LT(camera::project(smooth, out.leds_in_world[n].col(l)).image.cwiseAbs().maxCoeff(), 0.96);
        const auto expected = expected_counts(rig(), c, {.x_in_world = out.leds_in_world[n].col(l)});
        for (int f = 0; f < 5; ++f)
          EXPECT_LT((out.counts.at(static_cast<std::int64_t>(5 * n) + f, l, c) - expected.counts)
                        .cwiseAbs()
                        .maxCoeff(),
                    8.0);
      }
}

TEST(TreePoses, ManyPosesBeginWithFewAndSetsDiffer) {
  const auto few = record_tree_poses(rig(), {.poses = 3}).value();
  const auto many = record_tree_poses(rig(), {.poses = 5}).value();
  EXPECT_TRUE(std::equal(few.counts.counts.begin(), few.counts.counts.end(), many.counts.counts.begin()));
  const auto other = record_tree_poses(rig(), {.poses = 3, .set = 1}).value();
  EXPECT_NE(few.leds_in_world[0], other.leds_in_world[0]);
}

TEST(TreePoses, RefuseWhatCannotBe) {
  EXPECT_THAT(record_tree_poses(rig(), {.poses = 0}).error().message, HasSubstr("0 poses of the tree"));
  EXPECT_THAT(record_tree_poses(rig(), {.frames_per_pose = -1}).error().message,
              HasSubstr("frames of each pose"));
  EXPECT_THAT(record_tree_poses(rig(), {.set = -1}).error().message, HasSubstr("set -1"));
  EXPECT_THAT(record_tree_poses(rig(), {.poses = 1, .recording = {.rate_hz = 500.0}}).error().message,
              HasSubstr("368.7 frames per second at most"));
  auto blind = rig();
  for (auto& camera : blind.rig.cameras) camera.cam_from_world.translation.x() += 10.0;
  EXPECT_THAT(record_tree_poses(blind, {.poses = 1}).error().message, HasSubstr("seen by all cameras"));
}

TEST(Scan, VisitsItsPositionsInTurn) {
  const ScanOptions options{.positions = {2, 3, 4}, .size_m = {0.4, 0.4, 0.3}, .frames_per_position = 3};
  const auto out = record_scan(rig(), options).value();
  EXPECT_TRUE(out.counts.validate());
  EXPECT_EQ(out.counts.frames(), 72);
  EXPECT_EQ(out.x_in_stage.col(0), Eigen::Vector3d(-0.2, -0.2, -0.15));
  EXPECT_EQ(out.x_in_stage.col(23), Eigen::Vector3d(0.2, 0.2, 0.15));
  double square = 0.0;
  for (int n = 0; n < 24; ++n) {
    square += (out.x_in_world.col(n) - out.world_from_stage * out.x_in_stage.col(n)).squaredNorm() / 72.0;
    const auto expected = expected_counts(rig(), 1, {.x_in_world = out.x_in_world.col(n)});
    for (int f = 0; f < 3; ++f)
      EXPECT_LT((out.counts.at(3 * n + f, 0, 1) - expected.counts).cwiseAbs().maxCoeff(), 8.0) << n;
  }
  EXPECT_NEAR(std::sqrt(square), 25e-6, 6e-6);
}

TEST(Scan, RefusesOptionsOutOfRange) {
  EXPECT_THAT(record_scan(rig(), {.positions = {1, 5, 5}}).error().message,
              HasSubstr("1 positions along an axis"));
  EXPECT_THAT(record_scan(rig(), {.size_m = {1, 0, 1}}).error().message, HasSubstr("a scan of 0 m"));
  EXPECT_THAT(record_scan(rig(), {.frames_per_position = 0}).error().message,
              HasSubstr("frames of each position"));
  EXPECT_THAT(record_scan(rig(), {.stage_sd_m = -1.0}).error().message, HasSubstr("0 or more"));
}

}  // namespace
}  // namespace kinemark::simulation

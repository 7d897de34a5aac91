// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace ts = testing_support;

/// A lattice of 5 x 5 x 4 positions, three frames each, the stage slightly rotated and shifted.
struct Scan {
  ScanPositions positions;
  math::SE3 world_from_stage;
  data::Counts counts;

  explicit Scan(const data::Rig& truth) {
    positions.frames_per_position = 3;
    positions.x_in_stage.resize(3, 100);
    for (int i = 0; i < 100; ++i) {
      const int row = i / 5 % 5, layer = i / 25;
      positions.x_in_stage.col(i) << 0.15 * (i % 5 - 2), 0.15 * (row - 2), 0.2 * layer - 0.3;
    }
    world_from_stage.rotation =
        Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, -2, 1).normalized()).toRotationMatrix();
    world_from_stage.translation << 0.004, -0.003, 0.005;
    counts = ts::count_paths(
        truth, 1, 300, 100.0,
        [&](int, double t) {
          const int position = std::clamp(static_cast<int>(t * 100.0 + 1e-6) / 3, 0, 99);
          return Eigen::Vector3d(world_from_stage * positions.x_in_stage.col(position));
        },
        8);
  }
};

BundleOptions small() {
  BundleOptions options;
  options.warp_degree = 4;
  options.crosstalk = false;
  return options;
}

TEST(Scan, CalibratesFromOneLedInKnownPositions) {
  const auto truth = ts::real_rig(12);
  const Scan scan(truth);
  const auto result = calibrate_scan(ts::ideal_rig(), scan.counts, scan.positions, small());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->rig.method, "scan");
  EXPECT_NEAR(result->report.chi2_per_dof, 1.0, 0.3);
  // What the world's gauge cannot hide: the distance of the lenses, and the warp.
  const auto base = [](const data::Rig& rig) {
    return (rig.cameras[0].centre_in_world() - rig.cameras[1].centre_in_world()).norm();
  };
  EXPECT_GT(std::abs(base(ts::ideal_rig()) - base(truth)), 2e-3);
  EXPECT_LT(std::abs(base(result->rig) - base(truth)), 5e-3);
  EXPECT_LT(result->report.side_rms_m, 2e-3);
}

TEST(Scan, UsesThePositionsThatWereVisitedBeforeItWasCutOff) {
  const auto rig = ts::ideal_rig();
  Scan scan(rig);
  auto positions = scan.positions;
  positions.x_in_stage.conservativeResize(3, 120);
  positions.x_in_stage.rightCols(20).setConstant(0.5);
  positions.frames_per_position = 7;  // 42 of them, and 6 frames of the next
  const auto seen = scan_observations(scan.counts, rig, positions);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->leds(), 42);
  EXPECT_EQ(seen->frames_left_over, 6);
  EXPECT_EQ(seen->observations.size(), 84U);
}

TEST(Scan, PositionsThatAreNotThoseOfTheRecordingAreRefused) {
  const auto truth = ts::real_rig(12);
  const Scan scan(truth);
  auto other = scan.positions;
  other.x_in_stage *= 1.1;
  const std::string wide = calibrate_scan(ts::ideal_rig(), scan.counts, other, small()).error().message;
  EXPECT_THAT(wide, HasSubstr("do not match the recording: its distances are "));
  EXPECT_THAT(wide, Not(HasSubstr(" mm apart on the tree and ")));
  other = scan.positions;
  other.x_in_stage.row(0).reverseInPlace();
  EXPECT_FALSE(calibrate_scan(ts::ideal_rig(), scan.counts, other, small()));
  other = scan.positions;
  other.x_in_stage.rightCols(50).row(1).array() += 0.02;  // it slipped half-way
  EXPECT_THAT(calibrate_scan(ts::ideal_rig(), scan.counts, other, small()).error().message,
              HasSubstr("calibration refused"));
}

TEST(Scan, RefusesWhatDoesNotFit) {
  const auto rig = ts::ideal_rig();
  Scan scan(rig);
  auto positions = scan.positions;
  positions.frames_per_position = 2;
  EXPECT_THAT(scan_observations(scan.counts, rig, positions).error().message,
              HasSubstr("300 frames do not fit 100 positions"));
  positions.frames_per_position = 30;
  EXPECT_THAT(scan_observations(scan.counts, rig, positions).error().message,
              HasSubstr("300 frames hold 10 whole positions"));
  positions.x_in_stage = positions.x_in_stage.leftCols(5).eval();
  EXPECT_THAT(scan_observations(scan.counts, rig, positions).error().message,
              HasSubstr("a scan of 5 positions"));
  scan.counts.leds.emplace_back("second");
  EXPECT_FALSE(scan_observations(scan.counts, rig, scan.positions));
}

}  // namespace
}  // namespace kinemark::calibration

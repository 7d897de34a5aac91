// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
namespace ts = testing_support;

const Vector3d kPlace(0.1, -0.15, 0.05);

Vector3d still(int led, double) { return kPlace + Vector3d(0.1 * led, 0.0, 0.0); }

data::Counts recording(const data::Rig& rig, std::int64_t frames = 60) {
  return ts::count_paths(rig, 2, frames, 100.0, still, 9);
}

void set(data::Counts& counts, std::int64_t f, std::int64_t led, std::int64_t c, std::int16_t value) {
  for (std::size_t k = 0; k < 4; ++k) counts.counts[4 * counts.index(f, led, c) + k] = value;
}

TEST(Reconstruct, PointsLieWhereTheyShouldWithinTheirError) {
  const auto rig = ts::real_rig(2);
  const auto counts = recording(rig, 300);
  ReconstructOptions options;
  options.flicker_counts = 0.0;
  const auto r = reconstruct(counts, rig, options);
  ASSERT_TRUE(r) << r.error().message;
  ASSERT_TRUE(r->points.validate());
  double z2 = 0.0;
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t led = 0; led < 2; ++led) {
      ASSERT_TRUE(r->points.present(f, led));
      const Vector3d error = r->points.x(f, led) - still(static_cast<int>(led), 0.0);
      z2 += error.x() * error.x() / r->points.covariance[6 * r->points.index(f, led)] / 600.0;
    }
  EXPECT_NEAR(z2, 1.0, 0.15);
  EXPECT_EQ(r->leds[1].located, 300);
  EXPECT_NEAR(r->points.sample_offset_s[1] - r->points.sample_offset_s[0], 904e-6, 1e-9);
}

TEST(Reconstruct, SameBitsForAnyNumberOfThreads) {
  const auto rig = ts::real_rig(2);
  const auto counts = recording(rig, 600);
  ReconstructOptions one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(reconstruct(counts, rig, one)->points.x_in_world,
            reconstruct(counts, rig, four)->points.x_in_world);
}

TEST(Reconstruct, SaysWhyFramesAreNotThere) {
  const auto rig = ts::real_rig(2);
  auto counts = recording(rig);
  set(counts, 3, 0, 1, 10);  // dim
  counts.flags[counts.index(4, 0, 0)] |= data::kCountSaturated;
  counts.flags[counts.index(5, 1, 0)] |= data::kCountLost;
  counts.counts[4 * counts.index(6, 1, 0)] += 120;  // one channel is wrong
  const auto r = reconstruct(counts, rig).value();
  EXPECT_EQ(r.points.state[r.points.index(3, 0)], data::SampleState::missing);
  EXPECT_EQ(r.points.state[r.points.index(6, 1)], data::SampleState::rejected);
  EXPECT_EQ(r.leds[0].occluded, 1);
  EXPECT_EQ(r.leds[0].saturated, 1);
  EXPECT_EQ(r.leds[1].occluded, 1);
  EXPECT_EQ(r.leds[1].inconsistent, 1);
  EXPECT_EQ(r.leds[0].located, 58);
}

TEST(Reconstruct, FlagsSpotsNearTheEdge) {
  const auto rig = ts::ideal_rig();
  const auto counts =
      ts::count_paths(rig, 1, 20, 100.0, [](int, double) { return Vector3d(0.0, 0.585, 0.0); }, 3);
  const auto r = reconstruct(counts, rig).value();
  EXPECT_EQ(r.leds[0].near_edge, r.leds[0].located);
  EXPECT_GT(r.leds[0].located, 15);
}

TEST(Reconstruct, CalibrationErrorAddsToTheNoise) {
  auto rig = ts::real_rig(2);
  const auto counts = recording(rig);
  const auto bare = reconstruct(counts, rig).value();
  rig.covariance = Eigen::MatrixXd::Zero(rig.parameter_count(), rig.parameter_count());
  rig.covariance(data::ParameterLayout::centre, data::ParameterLayout::centre) =
      1e-6;  // 1 mm of camera A along X
  const auto more = reconstruct(counts, rig).value();
  const auto i = 6 * bare.points.index(7, 0);
  const double added = more.points.covariance[i] - bare.points.covariance[i];
  EXPECT_GT(added, 0.1e-6);
  EXPECT_LT(added, 1.0e-6);
}

TEST(Reconstruct, RefusesWhatDoesNotFit) {
  const auto rig = ts::ideal_rig();
  const auto counts = recording(rig);
  auto other = counts;
  other.rig_id = "rig 7";
  auto mine = rig;
  mine.id = "rig 8";
  EXPECT_THAT(reconstruct(other, mine).error().message, HasSubstr("'rig 7', this rig is 'rig 8'"));
  mine = rig;
  mine.cameras[1].name = "C";
  EXPECT_THAT(reconstruct(counts, mine).error().message,
              HasSubstr("'B' in the recording and 'C' in the rig"));
  mine.cameras.pop_back();
  EXPECT_THAT(reconstruct(counts, mine).error().message, HasSubstr("2 cameras and the rig 1"));
  ReconstructOptions options;
  options.edge = 2.0;
  EXPECT_EQ(reconstruct(counts, rig, options).error().code, Code::usage);
}

TEST(Reconstruct, TellsDarknessAndBlindCameras) {
  const auto rig = ts::ideal_rig();
  auto counts = recording(rig);
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < 2; ++led) set(counts, f, led, 1, 8);
  EXPECT_THAT(reconstruct(counts, rig).error().message, HasSubstr("camera 'B' saw no light"));
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < 2; ++led) set(counts, f, led, 0, 8);
  EXPECT_THAT(reconstruct(counts, rig).error().message, HasSubstr("all LEDs are dark"));
}

TEST(Reconstruct, ClassicNeedsTables) {
  const auto rig = ts::ideal_rig();
  EXPECT_THAT(reconstruct_classic(recording(rig), rig).error().message, HasSubstr("has no look-up table"));
}

}  // namespace
}  // namespace kinemark::reconstruction

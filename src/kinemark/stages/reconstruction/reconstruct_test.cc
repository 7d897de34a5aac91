// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/data/calibration_error.h"
#include "kinemark/math/se3.h"
#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
namespace ts = testing_support;

const Vector3d kPosition(0.1, -0.15, 0.05);

Vector3d still(int led, double) { return kPosition + Vector3d(0.1 * led, 0.0, 0.0); }

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

TEST(Reconstruct, FieldsOfTheCalibrationErrorAreItsCovariance) {
  auto rig = ts::real_rig(2);
  const auto moving = [](int led, double time) {
    return Vector3d(still(led, 0.0) +
                    0.2 * Vector3d(std::sin(9.0 * time), std::cos(13.0 * time), std::sin(4.0 * time)));
  };
  const auto counts = ts::count_paths(rig, 2, 200, 100.0, moving, 9);
  const auto bare = reconstruct(counts, rig).value();
  EXPECT_FALSE(calibration_error(counts, rig, bare, bare.points).known());
  rig.covariance = Eigen::MatrixXd::Zero(rig.parameter_count(), rig.parameter_count());
  for (int k = 0; k < 3; ++k)  // where camera A stands
    rig.covariance(data::ParameterLayout::centre + k, data::ParameterLayout::centre + k) = 1e-6;
  const auto more = reconstruct(counts, rig).value();
  const auto error = calibration_error(counts, rig, more, more.points);
  EXPECT_GT(error.fields.size(), 1U);
  for (const std::int64_t f : {17, 90, 161}) {
    const data::Points at = more.points.x(f, 1).transpose();
    double square = 0.0;
    for (const auto& moved : data::displacements(error, at)) square += moved(0, 0) * moved(0, 0);
    const auto i = 6 * more.points.index(f, 1);
    const double added = more.points.covariance[i] - bare.points.covariance[i];
    EXPECT_NEAR(square, added, 0.15 * added) << f;  // cells of 2 cm there, polynomials here
  }
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

/// Rig and recording with the cameras in the opposite order.
void turn_cameras_round(data::Rig& rig, data::Counts& counts) {
  std::ranges::reverse(rig.cameras);
  const data::Counts was = counts;
  std::ranges::reverse(counts.cameras);
  for (std::int64_t led = 0; led < was.led_count(); ++led)
    for (std::int64_t c = 0; c < 2; ++c)
      for (std::int64_t k = 0; k < 4; ++k) {
        counts.conversion_time_s[static_cast<std::size_t>(4 * (2 * led + c) + k)] =
            was.conversion_time_s[static_cast<std::size_t>(4 * (2 * led + 1 - c) + k)];
        for (std::int64_t f = 0; f < was.frames(); ++f)
          counts.counts[4 * counts.index(f, led, c) + static_cast<std::size_t>(k)] =
              was.counts[4 * was.index(f, led, 1 - c) + static_cast<std::size_t>(k)];
      }
}

TEST(ReconstructLaws, PointsAndCovariancesMoveWithTheRig) {
  auto rig = ts::real_rig(2);
  const auto counts = recording(rig);
  const auto before = reconstruct(counts, rig).value().points;
  const math::SE3 move{Eigen::AngleAxisd(1.1, Vector3d(2.0, 1.0, -1.0).normalized()).toRotationMatrix(),
                       Vector3d(3.0, -1.5, 0.25)};
  for (auto& camera : rig.cameras) camera.cam_from_world = camera.cam_from_world * move.inverse();
  const auto after = reconstruct(counts, rig).value().points;
  ASSERT_EQ(after.state, before.state);
  const auto covariance = [](const data::Trajectories& t, std::int64_t f) {
    const double* v = t.covariance.data() + 6 * t.index(f, 1);
    return Eigen::Matrix3d{{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
  };
  for (std::int64_t f = 0; f < before.frames(); ++f) {
    EXPECT_LT((after.x(f, 1) - move * before.x(f, 1)).norm(), 1e-8) << f;
    const Eigen::Matrix3d rotated = move.rotation * covariance(before, f) * move.rotation.transpose();
    EXPECT_LT((covariance(after, f) - rotated).norm(), 1e-4 * rotated.norm()) << f;
  }
}

TEST(ReconstructLaws, CamerasMayComeInAnyOrder) {
  auto rig = ts::real_rig(2);
  auto counts = recording(rig);
  const auto before = reconstruct(counts, rig).value();
  turn_cameras_round(rig, counts);
  const auto after = reconstruct(counts, rig);
  ASSERT_TRUE(after) << after.error().message;
  ASSERT_EQ(after->points.state, before.points.state);
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < 2; ++led)
      EXPECT_LT((after->points.x(f, led) - before.points.x(f, led)).norm(), 1e-8) << f;
}

TEST(Reconstruct, ConversionsOfAFrameAreBroughtToOneTime) {
  const auto rig = ts::real_rig(3);
  constexpr double kTurning = 25.0, kWay_m = 0.2;
  const auto path = [](int led, double t) {
    return Vector3d(still(led, t) + Vector3d(kWay_m * std::sin(kTurning * t), 0.0, 0.0));
  };
  const auto counts = ts::count_paths(rig, 2, 2000, 100.0, path, 9);
  const auto points = reconstruct(counts, rig).value().points;
  Vector3d late = Vector3d::Zero();  // s by which each axis follows the velocity
  double squares = 0.0;
  for (std::int64_t f = 1; f + 1 < points.frames(); ++f) {
    if (!points.present(f, 1)) continue;
    const double t = points.time_s(f, 1), velocity = kWay_m * kTurning * std::cos(kTurning * t);
    late += velocity * (points.x(f, 1) - path(1, t));
    squares += velocity * velocity;
  }
  EXPECT_LT((late / squares).cwiseAbs().maxCoeff(), 1.5e-5);
}

TEST(ReconstructLaws, AFrameDependsOnTheOthersByItsVelocityAlone) {
  const auto rig = ts::real_rig(3);
  const auto counts = recording(rig, 40);
  const auto all = reconstruct(counts, rig).value().points;
  auto one =
      data::Counts::zeros(counts.leds, counts.cameras, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1}, false);
  one.conversion_time_s = counts.conversion_time_s;
  for (const std::int64_t f : {0, 17, 39}) {
    std::copy_n(counts.counts.begin() + static_cast<std::ptrdiff_t>(4 * counts.index(f, 0, 0)), 16,
                one.counts.begin());
    const auto alone = reconstruct(one, rig).value().points;
    for (std::int64_t led = 0; led < 2; ++led) EXPECT_LT((alone.x(0, led) - all.x(f, led)).norm(), 2e-5) << f;
  }
}

TEST(ReconstructLaws, CovariancesArePositiveAndGrowWithTheFlicker) {
  const auto rig = ts::real_rig(4);
  const auto counts = recording(rig, 30);
  ReconstructOptions options;
  double last = 0.0;
  for (const double flicker : {0.0, 1.0, 4.0}) {
    options.flicker_counts = flicker;
    const auto points = reconstruct(counts, rig, options).value().points;
    ASSERT_EQ(points.covariance.size(), 6U * 30 * 2);
    double trace = 0.0;
    for (std::int64_t f = 0; f < 30; ++f) {
      const double* v = points.covariance.data() + 6 * points.index(f, 0);
      const Eigen::Matrix3d c{{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
      EXPECT_GT(c.determinant(), 0.0);
      EXPECT_GT(c(0, 0), 0.0);
      trace += c.trace();
    }
    EXPECT_GT(trace, last) << flicker;
    last = trace;
  }
}

TEST(Reconstruct, CountsAddUpAndUsedTellsWhatServed) {
  const auto rig = ts::real_rig(2);
  auto counts = recording(rig);
  for (const std::int64_t f : {2, 3, 30}) counts.flags[counts.index(f, 1, 1)] |= data::kCountOccluded;
  counts.flags[counts.index(8, 1, 0)] |= data::kCountSaturated;
  const auto r = reconstruct(counts, rig).value();
  for (const auto& led : r.leds) {
    EXPECT_EQ(led.frames, 60);
    EXPECT_EQ(led.located + led.occluded + led.saturated + led.inconsistent, led.frames) << led.name;
  }
  EXPECT_EQ(r.leds[1].occluded, 3);
  ASSERT_EQ(r.used.size(), counts.flags.size());
  for (std::int64_t f = 0; f < 60; ++f)
    for (std::int64_t led = 0; led < 2; ++led)
      EXPECT_EQ(r.points.present(f, led),
                r.used[counts.index(f, led, 0)] != 0 && r.used[counts.index(f, led, 1)] != 0)
          << f << ' ' << led;
}

TEST(Reconstruct, EachOptionHasARange) {
  const auto refused = [](auto change) {
    ReconstructOptions options;
    change(options);
    const auto status = options.check();
    return !status && status.error().code == Code::usage;
  };
  EXPECT_TRUE(ReconstructOptions{}.check());
  for (const double bad : {-0.1, std::nan("")}) {
    EXPECT_TRUE(refused([bad](ReconstructOptions& o) { o.dim_share = bad; })) << bad;
    EXPECT_TRUE(refused([bad](ReconstructOptions& o) { o.largest_chi2 = bad; })) << bad;
    EXPECT_TRUE(refused([bad](ReconstructOptions& o) { o.edge = bad; })) << bad;
    EXPECT_TRUE(refused([bad](ReconstructOptions& o) { o.flicker_counts = bad; })) << bad;
  }
}

TEST(Reconstruct, AVideoCameraAndBrokenCountsAreRefused) {
  auto rig = ts::ideal_rig();
  const auto counts = recording(rig);
  auto broken = counts;
  broken.flags.pop_back();
  EXPECT_EQ(reconstruct(broken, rig).error().code, Code::bad_input);
  rig.cameras[1].kind = data::CameraKind::pinhole;
  EXPECT_THAT(reconstruct(counts, rig).error().message, HasSubstr("camera 'B' is no lateral-effect camera"));
}

TEST(Reconstruct, ClassicNeedsTables) {
  const auto rig = ts::ideal_rig();
  EXPECT_THAT(reconstruct_classic(recording(rig), rig).error().message, HasSubstr("has no look-up table"));
}

}  // namespace
}  // namespace kinemark::reconstruction

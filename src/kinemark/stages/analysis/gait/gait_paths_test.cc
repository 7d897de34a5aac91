// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using data::Side;
using Eigen::Vector3d;

constexpr double kRate = 100.0;
constexpr std::int64_t kFrames = 200;

// Feet that point to (0.6, 0.8) and glide along it at 1 m/s, under a pelvis; no noise.
class GaitPathsTest : public ::testing::Test {
 protected:
  GaitPathsTest() {
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (std::int64_t m = 0; m < 5; ++m) {
        markers_.x(f, m) = place(f, m);
        markers_.state[markers_.index(f, m)] = data::SampleState::measured;
      }
  }
  static Vector3d place(std::int64_t f, std::int64_t m) {
    const Vector3d heel(0.6 * 0.01 * static_cast<double>(f), 0.8 * 0.01 * static_cast<double>(f), 0.04);
    if (m == 4) return heel + Vector3d(0, 0, 0.9);
    const double side = m < 2 ? 0.05 : -0.05;
    return heel + Vector3d(-0.8 * side, 0.6 * side, 0) +
           (m % 2 == 1 ? Vector3d(0.12, 0.16, 0) : Vector3d(0, 0, 0));
  }
  [[nodiscard]] Result<GaitSmoother> create(double noise_sd_m = 0.0) const {
    return GaitSmoother::create(markers_, find_gait_markers(markers_).value(), noise_sd_m);
  }

  data::Trajectories markers_ = data::Trajectories::all_missing(
      {"LHEE", "LTOE", "RHEE", "RTOE", "SACR"}, {.rate_hz = kRate, .t0_s = 2.0, .frames = kFrames});
};

TEST_F(GaitPathsTest, AStraightPathStaysAsItIs) {
  const auto paths = create().value().paths();
  EXPECT_EQ(paths.frames(), kFrames);
  EXPECT_NEAR(paths.time_s(50.5), 2.505, 1e-12);
  for (std::int64_t f = 0; f < kFrames; f += 7) {
    EXPECT_NEAR((paths.foot(Side::left).heel.row(f).transpose() - place(f, 0)).norm(), 0.0, 1e-8);
    EXPECT_NEAR((paths.foot(Side::right).toe.row(f).transpose() - place(f, 3)).norm(), 0.0, 1e-8);
    EXPECT_NEAR((paths.pelvis.row(f).transpose() - place(f, 4)).norm(), 0.0, 1e-8);
    EXPECT_TRUE(paths.pelvis_known[static_cast<std::size_t>(f)]);
  }
}

TEST_F(GaitPathsTest, UpIsWhereThePelvisStandsUnlessItIsStated) {
  EXPECT_EQ(create().value().standing(), Vector3d::UnitZ());
  EXPECT_TRUE(create().value().upright().isIdentity(1e-12));
  const auto stated =
      GaitSmoother::create(markers_, find_gait_markers(markers_).value(), 0.0, Vector3d::UnitY());
  ASSERT_TRUE(stated);
  EXPECT_EQ(stated->standing(), Vector3d::UnitZ());
  EXPECT_TRUE((stated->upright() * Vector3d::UnitY()).isApprox(Vector3d::UnitZ()));
}

// A two-pass Butterworth filter whose power is half at 8 Hz: gain 1 / (1 + (f / 9.97 Hz)^4).
TEST_F(GaitPathsTest, SwingsAreDampedAsTheLowPassDampsThem) {
  for (const auto& [hz, gain] : {std::pair{3.5, 0.985}, std::pair{8.0, std::sqrt(0.5)}, std::pair{9.972, 0.5},
                                 std::pair{16.0, 0.131}}) {
    const auto swing = [hz = hz](std::int64_t f) {
      return 0.02 * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(f) / kRate);
    };
    for (std::int64_t f = 0; f < kFrames; ++f) markers_.x(f, 0) = place(f, 0) + Vector3d(0, 0, swing(f));
    const auto heel = create().value().paths().foot(Side::left).heel;
    double product = 0.0, square = 0.0;
    for (std::int64_t f = 50; f < 150; ++f) {
      product += swing(f) * (heel(f, 2) - 0.04);
      square += swing(f) * swing(f);
    }
    EXPECT_NEAR(product / square, gain, 0.03) << hz;
  }
}

TEST_F(GaitPathsTest, AFootIsKnownInShortGapsAndHiddenInLongOnes) {
  for (std::int64_t f = 20; f < 45; ++f) markers_.set_missing(f, 0);  // LHEE, 0.25 s
  for (std::int64_t f = 60; f < 120; ++f) markers_.set_missing(f, 0), markers_.set_missing(f, 1);
  for (std::int64_t f = 0; f < 5; ++f) markers_.set_missing(f, 1);  // at the beginning
  const auto smoother = create().value();
  const auto& known = smoother.paths().foot(Side::left).known;
  for (std::int64_t f = 0; f < kFrames; ++f)
    EXPECT_EQ(known[static_cast<std::size_t>(f)], f >= 5 && (f < 60 || f >= 120)) << f;
  const auto& seen = smoother.seen(Side::left);
  ASSERT_EQ(seen.hidden.size(), 1u);
  EXPECT_EQ(seen.hidden[0].first, 60);
  EXPECT_EQ(seen.hidden[0].last, 119);
  EXPECT_NEAR(seen.share, 110.0 / 200.0, 1e-12);
  for (const bool one : smoother.paths().foot(Side::right).known) EXPECT_TRUE(one);
  // The gap lies on the line.
  EXPECT_NEAR((smoother.paths().foot(Side::left).toe.row(90).transpose() - place(90, 1)).norm(), 0.0, 1e-7);
}

TEST_F(GaitPathsTest, APelvisMarkerThatDropsOutMakesNoJump) {
  markers_.names = {"LHEE", "LTOE", "RHEE", "RTOE", "SACR", "LASI"};
  auto more =
      data::Trajectories::all_missing({"LHEE", "LTOE", "RHEE", "RTOE", "LASI", "RASI"}, markers_.time);
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      more.x(f, m) = m < 5 ? place(f, m) : place(f, 4) + Vector3d(0.1, -0.2, 0.0);
      if (m < 5 || f < 90 || f > 110)
        more.state[more.index(f, m)] = data::SampleState::measured;
      else
        more.set_missing(f, m);
    }
  const auto paths = GaitSmoother::create(more, find_gait_markers(more).value(), 0.0).value().paths();
  for (std::int64_t f = 0; f < kFrames; ++f)
    EXPECT_NEAR((paths.pelvis.row(f).transpose() - place(f, 4) - Vector3d(0.05, -0.1, 0.0)).norm(), 0.0,
                1e-6);
}

TEST_F(GaitPathsTest, ASecondCutOffIsThatOfTheSecond) {
  auto smoother = create().value();
  for (std::int64_t f = 0; f < kFrames; ++f)
    markers_.x(f, 0) =
        place(f, 0) + Vector3d(0, 0, 0.02 * std::sin(2.0 * std::numbers::pi * 0.16 * static_cast<double>(f)));
  smoother = create().value();
  const auto heel = [&] {
    return smoother.paths().foot(Side::left).heel.col(2).segment(50, 100).array() - 0.04;
  };
  const double first = std::sqrt(heel().square().mean());
  ASSERT_TRUE(smoother.smooth_at(20.0));
  EXPECT_GT(std::sqrt(heel().square().mean()), 5.0 * first);
  ASSERT_TRUE(smoother.smooth_at(kFirstCutOff_hz));
  EXPECT_NEAR(std::sqrt(heel().square().mean()), first, 1e-12);
}

TEST_F(GaitPathsTest, ExchangedSidesAreEachOthers) {
  auto smoother = create().value();
  const auto left = smoother.paths().foot(Side::left).heel;
  smoother.exchange_sides();
  EXPECT_EQ(smoother.paths().foot(Side::right).heel, left);
  EXPECT_NEAR((smoother.with_noise(1, 0).foot(Side::right).heel - left).norm(), 0.0, 1e-9);
}

TEST_F(GaitPathsTest, ZIsUpWhicheverAxisOfTheLaboratoryIs) {
  const auto upright = create().value().paths();
  for (const int axis : {0, 1, 2})
    for (const double sign : {1.0, -1.0}) {
      Eigen::Matrix3d lab = Eigen::Matrix3d::Zero();  // from z up to this laboratory, right-handed
      lab((axis + 1) % 3, 0) = 1.0, lab((axis + 2) % 3, 1) = sign, lab(axis, 2) = sign;
      for (std::int64_t f = 0; f < kFrames; ++f)
        for (std::int64_t m = 0; m < 5; ++m) markers_.x(f, m) = lab * place(f, m);
      const auto smoother = create();
      ASSERT_TRUE(smoother);
      EXPECT_NEAR(smoother->upright().determinant(), 1.0, 1e-12);
      EXPECT_NEAR((smoother->upright() * lab.col(2) - Vector3d::UnitZ()).norm(), 0.0, 1e-12);
      const auto& paths = smoother->paths();
      EXPECT_NEAR(paths.pelvis(77, 2), 0.94, 1e-7);
      EXPECT_NEAR((paths.foot(Side::left).heel.row(10) - paths.foot(Side::right).heel.row(10)).norm(),
                  (upright.foot(Side::left).heel.row(10) - upright.foot(Side::right).heel.row(10)).norm(),
                  1e-7);
    }
}

TEST_F(GaitPathsTest, MarkersBelievedInTooFewFramesAreRefused) {
  const auto which = find_gait_markers(markers_).value();
  for (std::int64_t f = 5; f < kFrames; ++f) markers_.set_missing(f, 3);
  EXPECT_EQ(GaitSmoother::create(markers_, which, 0.0).error().message,
            "RTOE is usable in 5 frames; need 8 at least");
}

TEST_F(GaitPathsTest, RatesBelowTwentyAreTooLow) {
  markers_.time.rate_hz = 19.9;
  EXPECT_EQ(create().error().message, "19.9 frames a second are too few for events of walking; need 20");
  EXPECT_EQ(create().error().code, Code::bad_input);
  for (const double rate : {0.0, -100.0, std::nan("")}) {
    markers_.time.rate_hz = rate;
    EXPECT_FALSE(create()) << rate;
  }
  markers_.time.rate_hz = 20.0;
  EXPECT_TRUE(create());
}

TEST_F(GaitPathsTest, NoiseIsAStreamOfItsSeedAndNumberAndGrowsWithItsSd) {
  const auto small = create(0.001).value(), large = create(0.002).value();
  const auto heel_of = [](const GaitPaths& paths) { return paths.foot(Side::left).heel; };
  const math::SeriesMatrix one = heel_of(small.with_noise(5, 0)) - heel_of(small.paths());
  const math::SeriesMatrix two = heel_of(large.with_noise(5, 0)) - heel_of(large.paths());
  EXPECT_GT(one.norm(), 0.0);
  EXPECT_NEAR((two - 2.0 * one).norm(), 0.0, 1e-9);
  EXPECT_EQ(heel_of(small.with_noise(5, 0)), heel_of(small.with_noise(5, 0)));
  EXPECT_GT((heel_of(small.with_noise(6, 0)) - heel_of(small.with_noise(5, 0))).norm(), 1e-4);
  EXPECT_GT((heel_of(small.with_noise(5, 1)) - heel_of(small.with_noise(5, 0))).norm(), 1e-4);
  // Markers have noise of their own.
  const auto noisy = small.with_noise(5, 0);
  EXPECT_GT(((noisy.pelvis - small.paths().pelvis) - one).norm(), 1e-4);
  EXPECT_EQ(noisy.foot(Side::left).known, small.paths().foot(Side::left).known);
}

TEST_F(GaitPathsTest, WithoutNoiseEveryRefitIsTheRecording) {
  const auto exact = create().value();
  EXPECT_NEAR((exact.with_noise(1, 0).pelvis - exact.paths().pelvis).norm(), 0.0, 1e-9);
}

TEST_F(GaitPathsTest, AFootWithoutMarkersIsNotThere) {
  markers_.names = {"LHEE", "LTOE", "X1", "X2", "SACR"};
  const auto paths = create().value().paths();
  EXPECT_TRUE(paths.foot(Side::left).present());
  EXPECT_FALSE(paths.foot(Side::right).present());
}

}  // namespace
}  // namespace kinemark::analysis

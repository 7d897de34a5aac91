// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/lateral_rig.h"

namespace kinemark::trajectory {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
namespace ts = testing_support;

constexpr std::int64_t kFrames = 260;
constexpr double kOmega = 3.0 * std::numbers::pi;

/// A circle of 15 cm at 1.5 Hz, 1.4 m/s; another LED stands still.
Vector3d circle(int led, double t) {
  if (led == 1) return {-0.1, 0.2, 0.1};
  return {0.15 * std::cos(kOmega * t), 0.15 * std::sin(kOmega * t), 0.05 * std::sin(kOmega * t + 0.4)};
}

Vector3d circle_velocity(double t) {
  return kOmega * Vector3d(-0.15 * std::sin(kOmega * t), 0.15 * std::cos(kOmega * t),
                           0.05 * std::cos(kOmega * t + 0.4));
}

/// Where to begin: the truth a centimetre off.
data::Trajectories rough(const data::Counts& counts) {
  auto out = data::Trajectories::all_missing(counts.leds, counts.time);
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < counts.led_count(); ++led) {
      out.x(f, led) = circle(static_cast<int>(led), counts.time.time_s(f)) + Vector3d(0.004, -0.006, 0.005);
      out.state[out.index(f, led)] = data::SampleState::measured;
    }
  return out;
}

void hide(data::Counts& counts, std::int64_t led, std::int64_t camera, std::int64_t first,
          std::int64_t last) {
  for (std::int64_t f = first; f < last; ++f)
    for (std::size_t k = 0; k < 4; ++k) counts.counts[4 * counts.index(f, led, camera) + k] = 8;
}

struct Errors {
  double position_m = 0.0, velocity_m_s = 0.0,
         z2 = 0.0;  // root mean square; mean square over predicted variance
};

Errors errors_of(const SmoothedCounts& s, std::int64_t first, std::int64_t last) {
  Errors out;
  double n = 0.0;
  for (std::int64_t f = first; f < last; ++f) {
    if (!s.points.present(f, 0)) continue;
    const auto i = s.points.index(f, 0);
    const double t = s.points.time.time_s(f);
    const Vector3d error = s.points.x(f, 0) - circle(0, t);
    const Vector3d velocity =
        Eigen::Map<const Vector3d>(s.derivatives.velocity.data() + 3 * i) - circle_velocity(t);
    out.position_m += error.squaredNorm();
    out.velocity_m_s += velocity.squaredNorm();
    out.z2 += (error.x() * error.x() / s.points.covariance[6 * i] +
               error.y() * error.y() / s.points.covariance[6 * i + 3]) /
              2.0;
    n += 1.0;
  }
  return {std::sqrt(out.position_m / n), std::sqrt(out.velocity_m_s / n), out.z2 / n};
}

class SmoothCounts : public ::testing::Test {
 protected:
  data::Rig rig = ts::real_rig(5);
  data::Counts counts = ts::count_paths(rig, 2, kFrames, 100.0, circle, 21);
};

TEST_F(SmoothCounts, BeatsSingleFramesAndSaysHowWell) {
  const auto s = smooth_counts(counts, rig, rough(counts));
  ASSERT_TRUE(s) << s.error().message;
  ASSERT_TRUE(s->points.validate());
  ASSERT_TRUE(s->derivatives.validate(s->points));
  const auto e = errors_of(*s, 10, kFrames - 10);
  EXPECT_LT(e.position_m, 0.4e-3);  // one frame: 0.8 mm
  EXPECT_LT(e.velocity_m_s, 0.012);
  EXPECT_GT(e.z2, 0.4);
  EXPECT_LT(e.z2, 1.6);
  EXPECT_NEAR(s->leds[0].chi2_per_dof, 1.0, 0.25);
  EXPECT_LT(s->leds[1].bandwidth.cutoff_hz, s->leds[0].bandwidth.cutoff_hz);
}

TEST_F(SmoothCounts, UsesEachConversionAtItsOwnTime) {
  // The same counts declared as simultaneous: the path is late by the middle of the slot, 1.4 m/s x 0.45 ms
  // and more.
  auto simultaneous = counts;
  for (auto& t : simultaneous.conversion_time_s) t = rig.electronics.time_constant_s;
  const auto right = errors_of(smooth_counts(counts, rig, rough(counts)).value(), 10, kFrames - 10);
  const auto wrong = errors_of(smooth_counts(simultaneous, rig, rough(counts)).value(), 10, kFrames - 10);
  EXPECT_GT(wrong.position_m, 1.8 * right.position_m);
}

TEST_F(SmoothCounts, BridgesAGapWithHonestError) {
  hide(counts, 0, 0, 120, 132);
  hide(counts, 0, 1, 126, 130);
  const auto s = smooth_counts(counts, rig, rough(counts)).value();
  EXPECT_EQ(s.points.state[s.points.index(128, 0)], data::SampleState::model_filled);
  EXPECT_EQ(s.points.state[s.points.index(122, 0)], data::SampleState::measured);
  EXPECT_EQ(s.points.made_by(128, 0), "smoother");
  const auto gap = errors_of(s, 120, 132);
  EXPECT_LT(gap.position_m, 3e-3);
  EXPECT_LT(gap.z2, 4.0);
  EXPECT_GT(s.points.covariance[6 * s.points.index(128, 0)],
            2.0 * s.points.covariance[6 * s.points.index(60, 0)]);
}

TEST_F(SmoothCounts, LongGapsStayOpen) {
  hide(counts, 0, 0, 100, 160);
  hide(counts, 0, 1, 100, 160);
  const auto s = smooth_counts(counts, rig, rough(counts)).value();
  EXPECT_FALSE(s.points.present(130, 0));
  EXPECT_TRUE(std::isnan(s.derivatives.velocity[3 * s.points.index(130, 0)]));
  EXPECT_LT(errors_of(s, 0, kFrames).position_m, 1e-3);
}

TEST_F(SmoothCounts, OutliersDoNoHarm) {
  for (const std::int64_t f : {40, 41, 90, 150, 151, 152})
    for (std::size_t k = 0; k < 4; ++k)
      counts.counts[4 * counts.index(f, 0, 1) + k] =
          static_cast<std::int16_t>(counts.counts[4 * counts.index(f, 0, 1) + k] + 40 * (k == 1));
  const auto s = smooth_counts(counts, rig, rough(counts)).value();
  EXPECT_GE(s.leds[0].rejected, 5);
  EXPECT_LT(errors_of(s, 10, kFrames - 10).position_m, 0.45e-3);
}

/// The circle, which leaves its path along x by `size_m` for `length_s`, every 0.7 s: at once, or in half a
/// sine.
ts::PathOfLed leaving(double size_m, double length_s, bool at_once) {
  return [=](int led, double t) {
    const double since = std::fmod(t, 0.7) - 0.3;
    if (led == 1 || since < 0.0 || since > length_s) return circle(led, t);
    const double share = at_once ? 1.0 : std::sin(std::numbers::pi * since / length_s);
    return Vector3d(circle(led, t) + share * Vector3d(size_m, 0.0, 0.0));
  };
}

// A mirror shifts both cameras' view of the point, so that no frame contradicts itself.
TEST_F(SmoothCounts, AFlashThatBothCamerasSeeIsNotFollowed) {
  const auto flashed = ts::count_paths(rig, 2, kFrames, 100.0, leaving(0.006, 0.015, true), 21);
  const auto s = smooth_counts(flashed, rig, rough(flashed)).value();
  EXPECT_LT(errors_of(s, 10, kFrames - 10).position_m, 0.6e-3);
  EXPECT_LT(s.leds[0].bandwidth.cutoff_hz, 20.0);
}

TEST_F(SmoothCounts, AMovementAsShortAsAPersonMakesItIsFollowed) {
  const auto path = leaving(0.02, 0.12, false);
  const auto tapped = ts::count_paths(rig, 2, kFrames, 100.0, path, 21);
  const auto s = smooth_counts(tapped, rig, rough(tapped)).value();
  double squares = 0.0;
  for (std::int64_t f = 10; f < kFrames - 10; ++f)
    squares += (s.points.x(f, 0) - path(0, s.points.time.time_s(f))).squaredNorm() / (kFrames - 20.0);
  EXPECT_LT(std::sqrt(squares), 1.5e-3);
}

TEST_F(SmoothCounts, FindsTheFlickerOfTheRoom) {
  const auto flickering = ts::count_paths(rig, 2, kFrames, 100.0, circle, 21, 3.0);
  const auto s = smooth_counts(flickering, rig, rough(counts)).value();
  for (const double amplitude : s.leds[0].flicker_counts) EXPECT_NEAR(amplitude, 3.0, 0.5);
  EXPECT_LT(errors_of(s, 10, kFrames - 10).position_m, 0.4e-3);
}

TEST_F(SmoothCounts, DarkSlotTellsTheFlicker) {
  auto flickering = ts::count_paths(rig, 2, kFrames, 100.0, circle, 21, 3.0);
  flickering.dark_time_s.resize(8);
  for (std::size_t i = 0; i < 8; ++i) flickering.dark_time_s[i] = 2.2e-3 + 48e-6 * static_cast<double>(i);
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::size_t i = 0; i < 8; ++i)
      flickering.dark.push_back(static_cast<std::int16_t>(std::round(
          20.0 +
          3.0 * std::sin(240.0 * std::numbers::pi * (flickering.time.time_s(f) + flickering.dark_time_s[i]) +
                         0.3))));
  SmoothCountsOptions options;
  options.flicker = Flicker::dark_slot;
  const auto s = smooth_counts(flickering, rig, rough(counts), options).value();
  for (const double amplitude : s.leds[1].flicker_counts) EXPECT_NEAR(amplitude, 3.0, 0.1);
}

TEST_F(SmoothCounts, SameBitsForAnyNumberOfThreads) {
  SmoothCountsOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const auto a = smooth_counts(counts, rig, rough(counts), one).value(),
             b = smooth_counts(counts, rig, rough(counts), two).value();
  EXPECT_EQ(a.points.x_in_world, b.points.x_in_world);
}

TEST_F(SmoothCounts, AnLedThatWasNeverSeenStaysMissing) {
  hide(counts, 1, 0, 0, kFrames);
  for (std::int64_t f = 0; f < kFrames; ++f) counts.flags[counts.index(f, 1, 1)] |= data::kCountLost;
  const auto s = smooth_counts(counts, rig, rough(counts)).value();
  EXPECT_FALSE(s.points.present(50, 1));
  EXPECT_EQ(s.derivatives.filters[1].method, "none");
  EXPECT_TRUE(s.points.present(50, 0));
}

TEST_F(SmoothCounts, RefusesWhatDoesNotFit) {
  auto start = rough(counts);
  start.names[0] = "other";
  EXPECT_THAT(smooth_counts(counts, rig, start).error().message, HasSubstr("do not fit 2 LEDs"));
  rig.cameras.pop_back();
  EXPECT_THAT(smooth_counts(counts, rig, rough(counts)).error().message, HasSubstr("the rig 1"));
  SmoothCountsOptions options;
  options.order = 7;
  EXPECT_EQ(options.check().error().code, Code::usage);
  options = {};
  options.passes = 1;
  EXPECT_FALSE(options.check());
}

}  // namespace
}  // namespace kinemark::trajectory

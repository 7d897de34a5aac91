// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_recording.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "kinemark/camera/noise.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using testing::HasSubstr;

const PhysicalRig& rig(bool dark_slot = false) {
  static const PhysicalRig plain = draw_rig({.seed = 2}).value();
  static const PhysicalRig with_dark = draw_rig({.seed = 2, .dark_slot = true}).value();
  return dark_slot ? with_dark : plain;
}

TEST(Record, IsValidAndTheSameForAnyNumberOfThreads) {
  const auto scene = signing_arm();
  const auto one = record(rig(true), scene, {.rate_hz = 150.0, .frames = 150, .threads = 1}).value();
  const auto four = record(rig(true), scene, {.rate_hz = 150.0, .frames = 150, .threads = 4}).value();
  EXPECT_TRUE(one.counts.validate()) << one.counts.validate().error().message;
  EXPECT_TRUE(one.truth.validate());
  EXPECT_TRUE(one.when_lit.validate());
  EXPECT_TRUE(one.derivatives.validate(one.truth));
  EXPECT_EQ(one.counts.counts, four.counts.counts);
  EXPECT_EQ(one.counts.dark, four.counts.dark);
  EXPECT_EQ(one.truth.x_in_world, four.truth.x_in_world);
  EXPECT_EQ(one.hidden, four.hidden);
  const auto other = record(rig(true), scene, {.rate_hz = 150.0, .frames = 150, .seed = 2}).value();
  EXPECT_NE(one.counts.counts, other.counts.counts);
}

TEST(Record, ADarkSlotChangesNoOtherNoise) {
  // The pedestal is a whole number of counts, so the same noise gives the same counts above it.
  const auto scene = still_tree({});
  const auto plain = record(rig(false), scene, {.frames = 50}).value();
  const auto dark = record(rig(true), scene, {.frames = 50}).value();
  double worst = 0.0;
  for (std::int64_t f = 0; f < 50; ++f)
    worst = std::max(worst, (dark.counts.at(f, 0, 0) - plain.counts.at(f, 0, 0)).array().abs().maxCoeff());
  EXPECT_LE(worst, 17.0);
  EXPECT_GE(worst, 15.0);
}

TEST(Record, EachConversionHasItsTime) {
  const auto out = record(rig(true), signing_arm(), {.frames = 3}).value();
  EXPECT_NEAR(out.counts.offset_s(0, 0)[0], 320e-6, 1e-15);
  EXPECT_NEAR(out.counts.offset_s(0, 1)[0], 320e-6 + 4 * 48e-6, 1e-15);
  EXPECT_NEAR(out.counts.offset_s(3, 1)[3], 3 * 904e-6 + 320e-6 + 7 * 48e-6, 1e-15);
  EXPECT_NEAR(out.counts.dark_offset_s(0)[0], 4 * 904e-6 + 320e-6, 1e-15);
  // The middle of an observation, seen one time constant later than it was.
  EXPECT_NEAR(out.when_lit.sample_offset_s[1], 904e-6 + 320e-6 + 3.5 * 48e-6 - 35e-6, 1e-15);
}

TEST(Record, AMovingLedIsSeenWhereItWasATimeConstantBefore) {
  // An LED along X at 2.7 m/s, no noise: each channel equals the expectation at its own time.
  auto quiet = draw_rig({.seed = 4}).value();
  quiet.room[0].flicker_counts = quiet.room[1].flicker_counts = 0.0;
  RigScene scene;
  scene.leds = {"fast"};
  scene.led = [](int, double t) { return LedState{.x_in_world = {2.7 * t, 0.1, 0.0}}; };
  const auto out = record(quiet, scene, {.frames = 5, .noise = false}).value();
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < 4; ++k) {
      const double t = 0.04 + out.counts.offset_s(0, c)[k] - 35e-6;
      const Vector4d expected = expected_counts(quiet, c, scene.led(0, t)).counts;
      EXPECT_EQ(out.counts.at(4, 0, c)[k], std::nearbyint(expected[k])) << c << k;
    }
}

TEST(Record, TruthIsWhereTheSceneSays) {
  const auto scene = signing_arm();
  const auto out = record(rig(), scene, {.frames = 40, .t0_s = 1.0}).value();
  EXPECT_EQ(out.truth.x(7, 2), scene.led(2, 1.07).x_in_world);
  EXPECT_EQ(out.when_lit.x(7, 2), scene.led(2, out.when_lit.time_s(7, 2)).x_in_world);
  // Derivatives by the wheel, whose own are known.
  const auto wheel = record(rig(), rotating_wheel(), {.frames = 20}).value();
  const double w = 2.0 * std::numbers::pi * 1.5;
  for (std::int64_t f = 0; f < 20; ++f) {
    const Vector3d radius = Vector3d(wheel.truth.x(f, 0)) - wheel_pose().translation;
    const Eigen::Map<const Vector3d> v(&wheel.derivatives.velocity[static_cast<std::size_t>(3 * f)]);
    const Eigen::Map<const Vector3d> a(&wheel.derivatives.acceleration[static_cast<std::size_t>(3 * f)]);
    EXPECT_NEAR(v.norm(), 0.196 * w, 1e-9);
    EXPECT_NEAR(v.dot(radius), 0.0, 1e-10);
    EXPECT_LT((a + w * w * radius).norm(), 1e-6);
  }
}

TEST(Record, NoiseHasItsVarianceAndFlickerItsAmplitude) {
  auto scene = still_tree({});
  scene.leds = {"one"};
  const auto out = record(rig(), scene, {.rate_hz = 100.0, .frames = 3000}).value();
  const Vector4d expected = expected_counts(rig(), 0, scene.led(0, 0.0)).counts;
  Vector4d mean = Vector4d::Zero(), square = Vector4d::Zero();
  for (std::int64_t f = 0; f < 3000; ++f) {
    const Vector4d off = out.counts.at(f, 0, 0) - expected;
    mean += off / 3000.0;
    square += off.cwiseAbs2() / 3000.0;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.1);
  for (int k = 0; k < 4; ++k) {
    const double predicted = camera::conversion_variance(rig().rig.electronics, expected[k]) + 0.5;
    EXPECT_NEAR(square[k] / predicted, 1.0, 0.09);
  }
}

TEST(Record, OcclusionLeavesStrayLightOnly) {
  const auto out = record(rig(), signing_arm(), {.frames = 330}).value();
  const auto hidden = [&](std::int64_t f, int l, int c) { return out.hidden[out.counts.index(f, l, c)]; };
  EXPECT_EQ(hidden(119, 3, 1), 0);
  EXPECT_EQ(hidden(120, 3, 1), kHiddenOccluded);
  EXPECT_EQ(hidden(131, 3, 1), kHiddenOccluded);
  EXPECT_EQ(hidden(132, 3, 1), 0);
  EXPECT_EQ(hidden(120, 3, 0), 0);
  EXPECT_EQ(hidden(300, 1, 0) & hidden(306, 1, 1), kHiddenOccluded);
  EXPECT_LT(out.counts.at(125, 3, 1).sum(), 60.0);
  EXPECT_GT(out.counts.at(125, 3, 0).sum(), 1000.0);
  EXPECT_EQ(out.counts.flags[out.counts.index(125, 3, 1)], 0);  // finding it is for others
}

TEST(Record, BrightLedsSaturateAndAreFlagged) {
  const auto out = record(rig(), still_tree({}), {.frames = 4, .intensity = {1.0, 8.0, 1.0}}).value();
  EXPECT_TRUE(out.counts.has_flag(0, 1, 0, data::kCountSaturated));
  EXPECT_FALSE(out.counts.has_flag(0, 0, 0, data::kCountSaturated));
  EXPECT_EQ(out.counts.at(0, 1, 0).maxCoeff(), 4095.0);
}

TEST(Record, DarkLedsAreMissingInTheTruth) {
  auto scene = still_tree({});
  const auto bright = scene.led;
  scene.led = [bright](int led, double t) {
    auto state = bright(led, t);
    state.shining = led != 1;
    return state;
  };
  const auto out = record(rig(), scene, {.frames = 2}).value();
  EXPECT_EQ(out.hidden[out.counts.index(0, 1, 0)], kHiddenDark);
  EXPECT_FALSE(out.truth.present(0, 1));
  EXPECT_TRUE(out.truth.validate() && out.derivatives.validate(out.truth));
  EXPECT_LT(out.counts.at(0, 1, 0).sum(), 40.0);
}

TEST(RigRecordingOptions, TheHighestRateIsComputedAndRefusedBeyond) {
  const auto message = [](const RigRecordingOptions& options, int leds, bool dark) {
    const auto status = options.check(rig(dark).rig, leds);
    return status ? std::string("good") : status.error().message;
  };
  EXPECT_EQ(message({.rate_hz = 276.54}, 4, false), "good");
  EXPECT_EQ(message({.rate_hz = 277.0}, 4, false),
            "4 LEDs in slots of 904 us leave room for 276.5 frames per second at most; 277 were asked for");
  EXPECT_EQ(message({.rate_hz = 138.27}, 8, false), "good");
  EXPECT_THAT(message({.rate_hz = 138.27}, 8, true), HasSubstr("8 LEDs and a dark slot"));
  EXPECT_THAT(message({.rate_hz = 1107.0}, 1, false), HasSubstr("1 LED in slots"));
  EXPECT_THAT(message({}, 9, false), HasSubstr("1 to 8 LEDs; the scene has 9"));
  EXPECT_THAT(message({.rate_hz = 0.0}, 1, false), HasSubstr("positive rate"));
  EXPECT_THAT(message({.frames = 0}, 1, false), HasSubstr("0 frames"));
  EXPECT_THAT(message({.frames = 5'000'000}, 3, false), HasSubstr("10 million"));
  EXPECT_THAT(message({.intensity = {1.0}}, 2, false), HasSubstr("1 intensities for 2 LEDs"));
  EXPECT_THAT(message({.intensity = {-1.0}}, 1, false), HasSubstr("intensity -1"));
  EXPECT_FALSE(record(rig(), still_tree({}), {.rate_hz = 400.0}));
}

}  // namespace
}  // namespace kinemark::simulation

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_markers.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/stages/simulation/rig_recording.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

Vector3d where(double t, int marker) {
  return {0.1 * std::sin(6.0 * t) + 0.1 * marker, 0.2 * std::cos(5.0 * t), 1.0 + 0.1 * t};
}

/// Markers m0, m1, ... at 100 Hz from 2 s; m1 has a gap from frame 30 to 39.
data::Trajectories markers(int count) {
  std::vector<std::string> names;
  for (int m = 0; m < count; ++m) names.push_back("m" + std::to_string(m));
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 2.0, .frames = 100});
  for (std::int64_t f = 0; f < 100; ++f)
    for (int m = 0; m < count; ++m) {
      if (m == 1 && f >= 30 && f < 40) continue;
      out.x(f, m) = where(static_cast<double>(f) / 100.0, m);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(MarkersAsLeds, FollowTheMarkersBetweenFrames) {
  const auto scene = markers_as_leds(markers(3), {.centred = false}).value();
  EXPECT_EQ(scene.leds, (std::vector<std::string>{"m0", "m1", "m2"}));
  for (double t = 0.1; t < 0.9; t += 0.0137)
    EXPECT_LT((scene.led(2, t).x_in_world - where(t, 2)).norm(), 2e-7) << t;
  EXPECT_EQ(scene.led(0, 0.5).normal, Vector3d::UnitZ());
}

TEST(MarkersAsLeds, AreDarkInGapsAndOutsideTheRecording) {
  const auto scene = markers_as_leds(markers(2)).value();
  EXPECT_TRUE(scene.led(1, 0.29).shining);
  EXPECT_FALSE(scene.led(1, 0.295).shining);
  EXPECT_FALSE(scene.led(1, 0.395).shining);
  EXPECT_TRUE(scene.led(1, 0.40).shining);
  EXPECT_TRUE(scene.led(0, 0.0).shining);
  EXPECT_FALSE(scene.led(0, -0.01).shining);
  EXPECT_FALSE(scene.led(0, 0.995).shining);
}

TEST(MarkersAsLeds, TakeTheTimeOfEachSample) {
  auto late = markers(1);
  late.sample_offset_s = {0.003};
  const auto scene = markers_as_leds(late, {.centred = false}).value();
  EXPECT_LT((scene.led(0, 0.503).x_in_world - where(0.5, 0)).norm(), 1e-12);
}

TEST(MarkersAsLeds, AreTurnedAndMovedBeforeTheCameras) {
  const auto upright = markers_as_leds(markers(1), {.z_is_up = true, .centred = false}).value();
  const Vector3d x = where(0.5, 0);
  EXPECT_LT((upright.led(0, 0.5).x_in_world - Vector3d(x.x(), x.z(), -x.y())).norm(), 1e-6);
  const auto centred = markers_as_leds(markers(3)).value();
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (int f = 0; f < 100; ++f)
    for (int m : {0, 2}) {
      const Vector3d at = centred.led(m, f / 100.0).x_in_world;
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  EXPECT_LT((low + high).norm(), 1e-6);
}

TEST(MarkersAsLeds, CanBeRecorded) {
  const auto scene = markers_as_leds(markers(2), {.markers = {"m1"}}).value();
  const auto rig = draw_rig().value();
  const auto out = record(rig, scene, {.frames = 90}).value();
  EXPECT_TRUE(out.truth.present(10, 0));
  EXPECT_FALSE(out.truth.present(35, 0));
  EXPECT_EQ(out.hidden[out.counts.index(35, 0, 0)], kHiddenDark);
  EXPECT_GT(out.counts.at(10, 0, 0).sum(), 500.0);
  EXPECT_LT(out.counts.at(35, 0, 0).sum(), 40.0);
}

TEST(MarkersAsLeds, SaysWhatIsWrong) {
  EXPECT_THAT(markers_as_leds(markers(9)).error().message,
              HasSubstr("9 markers as LEDs; the rig drives 1 to 8"));
  EXPECT_THAT(markers_as_leds(markers(2), {.markers = {"hand"}}).error().message,
              HasSubstr("no marker 'hand'"));
  EXPECT_THAT(markers_as_leds(markers(2), {.markers = {"m0", "m0"}}).error().message,
              HasSubstr("named twice"));
  auto once = markers(1);
  for (std::int64_t f = 1; f < 100; ++f) once.set_missing(f, 0);
  EXPECT_THAT(markers_as_leds(once).error().message, HasSubstr("'m0' is never seen in two frames"));
  auto invalid = markers(1);
  invalid.time.rate_hz = 0.0;
  EXPECT_FALSE(markers_as_leds(invalid));
}

}  // namespace
}  // namespace kinemark::simulation

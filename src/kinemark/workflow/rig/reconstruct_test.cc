// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/reconstruct.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::workflow {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// A wheel before two cameras, and the rig as it is.
struct Wheel {
  simulation::PhysicalRig drawn = simulation::draw_rig({.seed = 7}).value();
  data::Rig rig = simulation::rig_in_room(drawn);
  simulation::RigRecording recording =
      simulation::record(drawn, simulation::rotating_wheel(), {.frames = 120}).value();
};

const Wheel& wheel() {
  static const Wheel shared;
  return shared;
}

double rms_error_m(const data::Trajectories& found, const data::Trajectories& truth) {
  double squares = 0.0, points = 0.0;
  for (std::int64_t f = 0; f < found.frames(); ++f)
    for (std::int64_t m = 0; m < found.markers(); ++m) {
      if (!found.present(f, m)) continue;
      squares += (found.x(f, m) - truth.x(f, m)).squaredNorm();
      points += 1.0;
    }
  return std::sqrt(squares / points);
}

TEST(Reconstruct, EachMethodFindsTheWheel) {
  for (const auto method : {ReconstructMethod::smoother, ReconstructMethod::frames}) {
    const auto found = reconstruct(wheel().recording.counts, wheel().rig, {.method = method});
    ASSERT_TRUE(found) << to_string(method) << ": " << found.error().message;
    EXPECT_EQ(found->markers.frames(), 120);
    EXPECT_EQ(found->leds.size(), found->markers.names.size());
    EXPECT_EQ(found->fits.empty(), method != ReconstructMethod::smoother);
    EXPECT_LT(rms_error_m(found->markers, method == ReconstructMethod::smoother ? wheel().recording.truth
                                                                                : wheel().recording.when_lit),
              0.005)
        << to_string(method);
  }
}

TEST(Reconstruct, ThreadsChangeNoBit) {
  const auto one = reconstruct(wheel().recording.counts, wheel().rig, {.threads = 1}).value();
  const auto two = reconstruct(wheel().recording.counts, wheel().rig, {.threads = 2}).value();
  EXPECT_EQ(one.markers.state, two.markers.state);
  for (std::size_t i = 0; i < one.markers.x_in_world.size(); ++i)
    if (!std::isnan(one.markers.x_in_world[i]))
      EXPECT_EQ(one.markers.x_in_world[i], two.markers.x_in_world[i]);
}

TEST(Reconstruct, OptionsOutOfRangeAreRefused) {
  EXPECT_FALSE(reconstruct(wheel().recording.counts, wheel().rig, {.frames = {.dim_share = -1.0}}));
  const auto classic =
      reconstruct(wheel().recording.counts, wheel().rig, {.method = ReconstructMethod::classic});
  ASSERT_FALSE(classic);
  EXPECT_THAT(classic.error().message, ::testing::HasSubstr("no look-up table"));
  EXPECT_EQ(to_string(ReconstructMethod::classic), "classic");
}

/// Four LEDs of a signing arm; the hand and the shoulder shine with another light.
struct Sign {
  simulation::PhysicalRig drawn;
  data::Rig rig;
  simulation::RigRecording recording;

  Sign(double light, bool dark_slot)
      : drawn(simulation::draw_rig({.seed = 9, .dark_slot = dark_slot}).value()),
        rig(simulation::rig_in_room(drawn)) {
    simulation::RigRecordingOptions how;
    how.frames = 300;
    how.intensity = {light, 1.0, 1.0, light};
    recording = simulation::record(drawn, simulation::signing_arm(), how).value();
    if (!dark_slot)
      for (auto& camera : rig.cameras) camera.detector.dark_counts.setConstant(kNaN);
  }
};

TEST(ReconstructLight, ADimLedIsNamedAndLiesWhereItIs) {
  const Sign sign(0.22, true);
  const auto found = reconstruct(sign.recording.counts, sign.rig).value();
  ASSERT_EQ(found.lights.size(), 4U);
  EXPECT_NEAR(found.lights[3].light, 0.22, 0.02 * 0.22);
  EXPECT_THAT(found.remarks.warnings,
              Contains(AllOf(HasSubstr("LED 'hand' shines with 0.22"), HasSubstr("it is dim"),
                             HasSubstr("the offsets are those of its light"))));
  EXPECT_THAT(found.remarks.warnings,
              Contains(HasSubstr("of the light of the calibration's LEDs: it is dim")));
  EXPECT_THAT(found.remarks.warnings,
              Not(Contains(HasSubstr(
                  "is not known, and its positions' deviations say so; calibrate with a dark slot"))));
  auto without = ReconstructOptions{};
  without.frames.light = false;
  const auto biased = reconstruct(sign.recording.counts, sign.rig, without).value();
  EXPECT_LT(rms_error_m(found.markers, sign.recording.truth),
            0.5 * rms_error_m(biased.markers, sign.recording.truth));
}

TEST(ReconstructLight, OffsetsThatDriftedAreThoseOfTheDarkSlots) {
  const Sign sign(1.0, true);
  auto earlier = sign.rig;
  for (auto& camera : earlier.cameras) {
    camera.detector.offset_counts += Eigen::Vector4d(5.0, -5.0, 3.0, 0.0);
    camera.detector.dark_counts += Eigen::Vector4d(5.0, -5.0, 3.0, 0.0);
  }
  const auto same = reconstruct(sign.recording.counts, sign.rig).value();
  const auto found = reconstruct(sign.recording.counts, earlier).value();
  EXPECT_NEAR(rms_error_m(found.markers, sign.recording.truth),
              rms_error_m(same.markers, sign.recording.truth), 5e-5);
  EXPECT_THAT(found.remarks.warnings,
              Contains(AllOf(
                  HasSubstr("camera 'A' reads up to 5."),
                  HasSubstr("counts other in the dark than at its calibration; its offsets are those of the "
                            "recording's dark slots"))));
  EXPECT_THAT(
      same.remarks.warnings,
      Not(Contains(HasSubstr("counts other in the dark than at its calibration; its offsets are those of the "
                             "recording's dark slots"))));
  auto as_calibrated = ReconstructOptions{};
  as_calibrated.frames.light = false;
  const auto biased = reconstruct(sign.recording.counts, earlier, as_calibrated).value();
  EXPECT_GT(rms_error_m(biased.markers, sign.recording.truth), 1e-3);
  EXPECT_THAT(biased.remarks.warnings, Not(Contains(HasSubstr("counts other in the dark than"))));
}

TEST(ReconstructLight, LedsOfTheCalibrationsLightAreNotNamed) {
  const Sign sign(1.0, true);
  const auto found = reconstruct(sign.recording.counts, sign.rig).value();
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("of the light of the calibration's LEDs"))));
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("the offsets are those of its light"))));
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("is brighter than the detector"))));
}

TEST(ReconstructLight, WithoutDarkCountsTheWarningNamesTheCure) {
  const Sign sign(0.5, false);
  const auto found = reconstruct(sign.recording.counts, sign.rig).value();
  EXPECT_THAT(found.remarks.warnings,
              Contains(AllOf(HasSubstr("LED 'hand' shines with 0.49"),
                             HasSubstr("positions' deviations say so; calibrate with a dark slot"))));
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("it is dim"))));
  // What is not known of the stray light is in the light's deviation too.
  EXPECT_NEAR(found.lights[3].light, 0.5, 2.0 * found.lights[3].light_sd);
  EXPECT_LT(found.lights[3].light_sd, 0.02);
}

TEST(ReconstructLight, DarkSlotsOfTheRecordingServeARigWithoutThem) {
  Sign sign(0.5, true);
  for (auto& camera : sign.rig.cameras) camera.detector.dark_counts.setConstant(kNaN);
  const auto found = reconstruct(sign.recording.counts, sign.rig).value();
  EXPECT_THAT(found.remarks.warnings, Contains(HasSubstr("the offsets are those of its light")));
}

TEST(ReconstructLight, AnLedThatFillsADetectorIsNamed) {
  const Sign sign(4.0, true);
  const auto found = reconstruct(sign.recording.counts, sign.rig).value();
  EXPECT_THAT(found.remarks.warnings, Contains(HasSubstr("LED 'hand' is brighter than the detector")));
}

}  // namespace
}  // namespace kinemark::workflow

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/sensor_part.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/example_trial.h"
#include "kinemark/stages/report/internal/ik_scene.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report::internal {
namespace {

using data::SampleState;
using ::testing::ElementsAre;

/// Two sensors: the first always 3 deg off, the second 4, but 12 in frame 7, and without a sample in 10 to
/// 19, of which that of 15 was left out.
ReportSensors two_sensors(std::int64_t frames) {
  ReportSensors out;
  out.rows = {{.name = "pelvis_imu", .body = "pelvis", .placed_by = "pose"},
              {.name = "shank_imu", .body = "shank", .placed_by = "pose", .rejected_samples = 1}};
  out.heading_rad = 30.0 * kRadPerDeg;
  out.heading_sd_rad = 0.5 * kRadPerDeg;
  out.heading_from = "motion";
  for (std::int64_t f = 0; f < frames; ++f) {
    const bool there = f < 10 || f >= 20;
    out.error_rad.push_back(3.0 * kRadPerDeg);
    out.error_rad.push_back(there ? (f == 7 ? 12.0 : 4.0) * kRadPerDeg : kNaN);
    out.state.push_back(SampleState::measured);
    out.state.push_back(there     ? SampleState::measured
                        : f == 15 ? SampleState::rejected
                                  : SampleState::missing);
  }
  return out;
}

/// A page of joint angles without markers.
struct Solved {
  ExampleTrial trial = example_trial(120);
  ReportSensors sensors = two_sensors(120);
  SceneBodies bodies;

  Solved() {
    trial.motion.markers.clear();
    trial.motion.marker_error.clear();
    trial.motion.marker_state.clear();
    trial.run.fit = {};
    trial.run.by_sensors = true;
    bodies.names = {"thigh", "pelvis"};
    bodies.mass_kg = {8.0, 10.0};
    for (std::int64_t f = 0; f < 120; ++f) {
      bodies.origin_in_world.insert(bodies.origin_in_world.end(), {0.0, 0.0, 0.0, 0.0, 1.0, 0.0});
      bodies.end_in_world.insert(bodies.end_in_world.end(),
                                 {0.0, -0.4, 0.0, 0.01 * static_cast<double>(f), 1.2, 0.0});
    }
  }
  [[nodiscard]] IkReport report() const {
    return {.summary = summarize(trial.run, trial.motion, nullptr).value(),
            .motion = &trial.motion,
            .up = Eigen::Vector3d::UnitY(),
            .sensors = &sensors,
            .bodies = &bodies};
  }
};

TEST(SensorPart, CountsAndAngles) {
  const auto json = sensors_json(two_sensors(100), {.rate_hz = 100.0, .t0_s = 2.0, .frames = 100});
  EXPECT_EQ(json["heading_deg"], 30.0);
  EXPECT_EQ(json["heading_sd_deg"], 0.5);
  EXPECT_TRUE(json["noise_sd_deg"].is_null()) << "not known";
  ASSERT_EQ(json["rows"].size(), 2U);
  EXPECT_EQ(json["rows"][0]["seen_frames"], 100);
  EXPECT_EQ(json["rows"][0]["rms_deg"], 3.0);
  const auto& shank = json["rows"][1];
  EXPECT_EQ(shank["body"], "shank");
  EXPECT_EQ(shank["seen_frames"], 90);
  EXPECT_EQ(shank["rejected_samples"], 1);
  EXPECT_NEAR(shank["rms_deg"].get<double>(), std::sqrt((89.0 * 16.0 + 144.0) / 90.0), 1e-4);
  EXPECT_EQ(shank["max_deg"], 12.0);
  EXPECT_EQ(shank["max_time_s"], 2.07);
  EXPECT_NEAR(json["rms_deg"].get<double>(), std::sqrt((900.0 + 89.0 * 16.0 + 144.0) / 190.0), 1e-4);
}

TEST(SensorPart, ASensorThatIsNeverUsedHasNoAngle) {
  auto sensors = two_sensors(15);
  for (std::size_t i = 1; i < sensors.error_rad.size(); i += 2) sensors.error_rad[i] = kNaN;
  const auto json = sensors_json(sensors, {.rate_hz = 100.0, .frames = 15});
  EXPECT_TRUE(json["rows"][1]["rms_deg"].is_null());
  EXPECT_TRUE(json["rows"][1]["max_time_s"].is_null());
  EXPECT_EQ(json["rms_deg"], 3.0);
}

TEST(SensorPart, APageWithoutMarkersHasTheirCurvesAndGaps) {
  const Solved solved;
  const auto json = report_json(solved.report());
  EXPECT_EQ(json["sensors"]["rows"].size(), 2U);
  EXPECT_TRUE(json["summary"]["markers"].empty());
  const auto& series = json["series"];
  ASSERT_EQ(series["sensor_error_deg"].size(), 2U);
  const auto shank = unpack_curve(series["sensor_error_deg"][1]),
             rms = unpack_curve(series["sensor_rms_deg"]);
  EXPECT_NEAR(shank[7], 12.0, 0.01);
  EXPECT_TRUE(std::isnan(shank[12]));
  EXPECT_NEAR(rms[7], std::sqrt((9.0 + 144.0) / 2.0), 0.01);
  EXPECT_NEAR(rms[12], 3.0, 0.01);
  const auto gaps = unpack_codes(series["sensor_gaps"][1]);
  EXPECT_EQ(gaps[9], 0);
  EXPECT_EQ(gaps[12], 2);
  EXPECT_EQ(gaps[15], 3);
}

TEST(SensorPart, SpaceShowsBodiesAndSensorsInTheMiddleOfTheirs) {
  const Solved solved;
  const auto scene = ik_scene_json(solved.report());
  ASSERT_FALSE(scene.is_null());
  EXPECT_THAT(scene["names"].get<std::vector<std::string>>(), ElementsAre("pelvis_imu"))
      << "the shank is not drawn";
  EXPECT_EQ(scene["bodies"]["names"].size(), 2U);
  const auto x = unpack_series(scene["markers"]["positions_m"]);
  EXPECT_NEAR(x[100], 0.5, 1e-3);
  EXPECT_NEAR(x[120 + 100], 1.1, 1e-3);
  auto without = solved.report();
  without.bodies = nullptr;
  EXPECT_TRUE(ik_scene_json(without).is_null());
}

TEST(SensorPart, APageOfMarkersAloneHasNone) {
  const auto trial = example_trial(120);
  const auto json =
      report_json({.summary = summarize(trial.run, trial.motion, nullptr).value(), .motion = &trial.motion});
  EXPECT_TRUE(json["sensors"].is_null());
  EXPECT_FALSE(json["series"].contains("sensor_error_deg"));
}

}  // namespace
}  // namespace kinemark::report::internal

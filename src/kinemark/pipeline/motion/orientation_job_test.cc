// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/orientation_job.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/shared_folder.h"
#include "kinemark/pipeline/testing/test_files.h"

namespace kinemark::pipeline {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class RunOrientations : public testing::SharedFolder<RunOrientations> {
 public:
  static void make_files() {
    testing::simulate_into(at("in"));
    ASSERT_TRUE(io::write_text(at("imu.sto"), sensors(false), true));
    ASSERT_TRUE(io::write_text(at("pose.sto"), sensors(true), true));
  }

 protected:
  /// The sensors of the simulated subject: their axes are those of the bodies, their world that of the model.
  static std::string sensors(bool standing) {
    const auto model = model::Model::compile(io::read_osim(at("in/model.osim")).value()).value();
    const auto truth = io::read_table(at("in/truth.mot")).value();
    const auto& coordinates = model.description().coordinates;
    std::string text = "DataType=Quaternion\nversion=3\nendheader\ntime";
    for (const auto& body : model.description().bodies) text += "\t" + body.name + "_imu";
    model::Workspace w(model);
    Eigen::VectorXd q(model.coordinate_count());
    for (std::int64_t r = 0; r < (standing ? 40 : truth.rows()); ++r) {
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& one = coordinates[static_cast<std::size_t>(c)];
        const auto column = truth.find(one.name);
        const double unit = one.is_rotation ? 3.14159265358979323846 / 180.0 : 1.0;
        q[c] = standing || column < 0 ? one.default_value : unit * truth(r, column);
      }
      model::kinematics(model, w, model::state_from_coordinates(model, q));
      text += fmt::format("\n{}", 0.01 * static_cast<double>(r));
      for (std::size_t d = 0; d < model.description().bodies.size(); ++d) {
        const Eigen::Quaterniond s(w.rotation[static_cast<std::size_t>(model.body_of(static_cast<int>(d)))]);
        text += fmt::format("\t{},{},{},{}", s.w(), s.x(), s.y(), s.z());
      }
    }
    return text + "\n";
  }
  static OrientationJob job() {
    OrientationJob out;
    out.force = true;
    out.model = at("in/model.osim");
    out.orientations = at("imu.sto");
    out.pose = at("pose.sto");
    out.output = at("Q.mot");
    return out;
  }
};

TEST_F(RunOrientations, WritesAnglesThatTheSensorsTookPartIn) {
  const auto outcome = run_orientations(job());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_EQ(outcome->written.size(), 4U);
  const auto q = io::read_table(at("Q.mot")).value();
  const auto truth = io::read_table(at("in/truth.mot")).value();
  ASSERT_EQ(q.rows(), truth.rows());
  for (const char* name : {"knee_angle_r", "hip_flexion_l", "elbow_flex_r"}) {
    ASSERT_GE(truth.find(name), 0) << name;
    for (std::int64_t r = 0; r < q.rows(); ++r)
      EXPECT_NEAR(q(r, q.find(name)), truth(r, truth.find(name)), 0.05) << name;
  }
  EXPECT_LT(outcome->result.fit.rms_rad, 1e-3);
  const auto json = orientation_json(*outcome);
  EXPECT_EQ(json["frames"], q.rows());
  EXPECT_EQ(json["sensors"].size(), outcome->result.fit.sensors.size());
  EXPECT_EQ(json["heading"]["from"], "motion");
  ASSERT_FALSE(json["inputs"].empty());
  for (const auto& input : json["inputs"]) EXPECT_EQ(input["hash_kind"], "XXH3-64") << "as run files read it";
  EXPECT_TRUE(json["gates"][0]["passed"]);
  for (const auto& warning : outcome->warnings) {
    EXPECT_THAT(warning, Not(HasSubstr("no body carries these sensors, which are not used")));
    EXPECT_THAT(warning,
                Not(HasSubstr("so that their noise does not show and the angles have no error bars")));
    EXPECT_THAT(warning, Not(HasSubstr("no frame that is solved has an orientation of these sensors")));
    EXPECT_THAT(warning, Not(HasSubstr("RMS angle between sensors and model")));
    EXPECT_THAT(
        warning,
        Not(HasSubstr(
            "is the pose that places the sensors the model's default, and --up the sensors' vertical?")));
    EXPECT_THAT(warning, Not(HasSubstr("a sensor turns in the first half second, whose first frame is taken "
                                       "for the model's default pose, by")));
    EXPECT_THAT(warning, Not(HasSubstr("a sensor turns within the pose that places the sensors by")));
    EXPECT_THAT(warning, Not(HasSubstr("give a recording of that pose, --calibration")));
    EXPECT_THAT(warning, Not(HasSubstr("give one in which the subject stands still")));
    EXPECT_THAT(warning, Not(HasSubstr("deg against the samples before and after: ")));
  }
}

TEST_F(RunOrientations, SamplesThatAreTurnedAreNamedAndLeftOutUnlessTheyAreKept) {
  auto recording = sensors(false);
  const auto line_of = [&recording](const std::string& time) { return recording.find("\n" + time + "\t"); };
  for (const char* time : {"0.1", "0.11"}) {  // the first sensor alone
    const auto begin = recording.find('\t', line_of(time)) + 1;
    recording.replace(begin, recording.find('\t', begin) - begin, "0.5,-0.5,0.5,0.5");
  }
  ASSERT_TRUE(io::write_text(at("turned.sto"), recording, true));
  auto with = job();
  with.orientations = at("turned.sto");
  const auto outcome = run_orientations(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto name = outcome->result.fit.sensors[0].name;
  EXPECT_THAT(outcome->warnings, Contains(AllOf(HasSubstr("sensor '" + name + "' is turned by up to"),
                                                HasSubstr("deg against the samples before and after: 2 "
                                                          "samples left out, at 0.10 to 0.11 s"))));
  const auto json = orientation_json(*outcome);
  EXPECT_EQ(json["rejected_samples"], 2);
  ASSERT_EQ(json["rejected"].size(), 1U);
  EXPECT_EQ(json["rejected"][0]["sensor"], name);
  EXPECT_EQ(json["rejected"][0]["in"], "recording");
  const auto errors = io::read_table(at("Q_orientation_errors.sto")).value();
  EXPECT_TRUE(std::isnan(errors(10, 0)));
  EXPECT_FALSE(std::isnan(errors(9, 0)));

  with.options.judge_samples = false;
  const auto kept = run_orientations(with);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(orientation_json(*kept)["rejected_samples"], 0);
  EXPECT_GT(kept->result.fit.max_rad, 0.3);
  for (const auto& warning : kept->warnings)
    EXPECT_THAT(warning, Not(HasSubstr("deg against the samples before and after: ")));
}

TEST_F(RunOrientations, SensorsThatNoBodyCarriesAreNamed) {
  auto text = sensors(false), pose = sensors(true);
  for (auto* one : {&text, &pose}) one->replace(one->find("hand_r_imu"), 10, "wristwatch");
  ASSERT_TRUE(io::write_text(at("watch.sto"), text, true));
  ASSERT_TRUE(io::write_text(at("watch_pose.sto"), pose, true));
  auto with = job();
  with.orientations = at("watch.sto");
  with.pose = at("watch_pose.sto");
  const auto outcome = run_orientations(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              Contains(HasSubstr("no body carries these sensors, which are not used: wristwatch")));
}

TEST_F(RunOrientations, SensorsThatAreNeverSeenAreNamed) {
  std::string text = "DataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\ttibia_r_imu\n",
              pose = text;
  for (int i = 0; i < 40; ++i) {
    text += fmt::format("{}\t1,0,0,0\tnan,nan,nan,nan\n", 0.01 * i);
    pose += fmt::format("{}\t1,0,0,0\t1,0,0,0\n", 0.01 * i);
  }
  ASSERT_TRUE(io::write_text(at("lost.sto"), text, true));
  ASSERT_TRUE(io::write_text(at("lost_pose.sto"), pose, true));
  auto lost = job();
  lost.orientations = at("lost.sto");
  lost.pose = at("lost_pose.sto");
  lost.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitX()};
  const auto outcome = run_orientations(lost);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(
      outcome->warnings,
      Contains(HasSubstr("no frame that is solved has an orientation of these sensors: tibia_r_imu")));
}

TEST_F(RunOrientations, ASensorAloneHasNoErrorBars) {
  const std::string head = "DataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\n";
  ASSERT_TRUE(io::write_text(at("one.sto"),
                             head + "0\t1,0,0,0\n0.01\t0.9998,0,0.02,0\n0.02\t0.9992,0,0.04,0\n", true));
  ASSERT_TRUE(io::write_text(at("one_pose.sto"), head + "0\t1,0,0,0\n0.01\t1,0,0,0\n", true));
  auto one = job();
  one.orientations = at("one.sto");
  one.pose = at("one_pose.sto");
  one.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitX()};
  const auto outcome = run_orientations(one);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              Contains(HasSubstr("so that their noise does not show and the angles have no error bars")));
  EXPECT_TRUE(orientation_json(*outcome)["noise_sd_deg"].is_null());
}

TEST_F(RunOrientations, APoseThatIsNotHeldMissesItsGate) {
  auto moving = job();
  moving.pose = at("imu.sto");
  moving.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitX()};
  const auto outcome = run_orientations(moving);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_THAT(outcome->warnings,
              Contains(HasSubstr("a sensor turns within the pose that places the sensors by")));
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("give one in which the subject stands still")));
}

TEST_F(RunOrientations, AFirstFrameThatIsNoPoseMissesItsGate) {
  auto moving = job();
  moving.pose.clear();
  moving.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitX()};
  const auto outcome = run_orientations(moving);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("give a recording of that pose, --calibration")));
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("a sensor turns in the first half second, whose first "
                                                    "frame is taken for the model's default pose, by")));
}

TEST_F(RunOrientations, AWrongVerticalMissesItsGate) {
  auto wrong = job();
  wrong.up = "x";
  wrong.max_rms_rad = 0.03;
  wrong.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitZ()};
  const auto outcome = run_orientations(wrong);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("RMS angle between sensors and model")));
  EXPECT_THAT(
      outcome->warnings,
      Contains(HasSubstr(
          "is the pose that places the sensors the model's default, and --up the sensors' vertical?")));
  EXPECT_EQ(outcome->exit_status(), 1);
  wrong.up = "q";
  EXPECT_EQ(run_orientations(wrong).error().code, Code::usage);
}

TEST_F(RunOrientations, FramesOfTheModelPlaceTheSensors) {
  auto text = io::read_text(at("in/model.osim")).value();
  const auto body = text.find("<Body name=\"tibia_r\"");
  ASSERT_NE(body, std::string::npos);
  text.insert(text.find('>', body) + 1,
              "<components><PhysicalOffsetFrame "
              "name=\"tibia_r_imu\"><socket_parent>..</socket_parent></PhysicalOffsetFrame></components>");
  ASSERT_TRUE(io::write_text(at("placed.osim"), text, true));
  auto placed = job();
  placed.model = at("placed.osim");
  placed.pose.clear();
  const auto outcome = run_orientations(placed);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->result.fit.sensors.size(), 1U);
  EXPECT_EQ(orientation_json(*outcome)["heading"]["from"], "model");
  EXPECT_EQ(outcome->gates.size(), 1U) << "no pose, no gate on it";
  placed.options.facing = motion::FacingAxis{.sensor = "tibia_r_imu", .axis = Eigen::Vector3d::UnitX()};
  EXPECT_THAT(run_orientations(placed).error().message,
              HasSubstr("--heading is for sensors that a pose places"));
  placed.pose = at("pose.sto");
  EXPECT_TRUE(run_orientations(placed)) << "a pose takes the place of the model's frames";
}

TEST_F(RunOrientations, WhatIsMissingIsSaid) {
  auto none = job();
  none.model.clear();
  EXPECT_THAT(run_orientations(none).error().message, HasSubstr("--model"));
  none = job();
  none.orientations.clear();
  EXPECT_THAT(run_orientations(none).error().message, HasSubstr("--orientations"));
  none = job();
  none.output.clear();
  EXPECT_THAT(run_orientations(none).error().message, HasSubstr("--output"));
  none = job();
  none.output = at("Q.csv");
  EXPECT_EQ(run_orientations(none).error().code, Code::usage);
  none = job();
  none.orientations = at("in/truth.mot");
  EXPECT_THAT(run_orientations(none).error().message, HasSubstr("holds no orientations"));
  none = job();
  none.output = at("imu.sto");
  EXPECT_FALSE(run_orientations(none)) << "an input is not replaced";
}

/// Sensors beside the markers of the same subject.
IkJob beside_markers(const OrientationJob& sensors, const std::filesystem::path& markers) {
  IkJob out;
  out.force = true;
  out.model = sensors.model;
  out.markers = markers;
  out.output = sensors.output;
  out.sensors = sensors;
  return out;
}

std::string option_of(const IkOutcome& outcome, std::string_view name) {
  for (const auto& [key, value] : outcome.summary.run.options)
    if (key == name) return value;
  return {};
}

TEST_F(RunOrientations, BesideMarkersBothTakePart) {
  auto with = beside_markers(job(), at("in/markers.c3d"));
  with.report = at("Q.html");
  const auto outcome = run_ik(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_EQ(outcome->written.size(), 6U);
  ASSERT_TRUE(outcome->sensor_fit);
  // Half a second of markers on moving skin: the heading is known to a few degrees, and says so.
  EXPECT_LT(outcome->sensor_fit->heading_sd_rad, 0.08);
  EXPECT_NEAR(outcome->sensor_fit->heading_rad, 0.0, 2.0 * outcome->sensor_fit->heading_sd_rad);
  EXPECT_LT(outcome->sensor_fit->rms_rad, 0.08);
  const auto errors = io::read_table(at("Q_orientation_errors.sto")).value();
  EXPECT_EQ(errors.columns.size(), outcome->sensor_fit->sensors.size());
  EXPECT_EQ(errors.rows(), io::read_table(at("Q_marker_errors.sto")).value().rows());
  const auto json = nlohmann::json::parse(io::read_text(at("Q_report.json")).value());
  EXPECT_EQ(json["orientations"]["heading"]["from"], "markers");
  EXPECT_EQ(json["orientations"]["sensors"][0]["placed_by"], "markers");
  EXPECT_THAT(option_of(*outcome, "orientations"), HasSubstr("how they stand on bodies said by markers for"));
  EXPECT_THAT(option_of(*outcome, "noise of an orientation"),
              HasSubstr("deg about each axis, estimated from the residuals"));
  EXPECT_THAT(option_of(*outcome, "angle between sensors and model"), HasSubstr("deg RMS, "));
  EXPECT_THAT(option_of(*outcome, "heading of the sensors"), HasSubstr("estimated (markers)"));
  for (const auto& warning : outcome->warnings)
    EXPECT_THAT(warning,
                Not(HasSubstr("markers do not determine the bodies of these sensors, which are not used; "
                              "--calibration would say how they stand there")));
  // Markers alone say nothing of sensors.
  auto alone = with;
  alone.sensors = {};
  const auto markers = run_ik(alone);
  ASSERT_TRUE(markers) << markers.error().message;
  EXPECT_FALSE(markers->sensor_fit);
  EXPECT_EQ(option_of(*markers, "orientations"), "");
  EXPECT_EQ(option_of(*markers, "noise of an orientation"), "");
}

TEST_F(RunOrientations, GivenNoiseBesideMarkersIsInTheOptions) {
  auto with = beside_markers(job(), at("in/markers.c3d"));
  with.sensors.options.noise_sd_rad = 0.02;
  const auto outcome = run_ik(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(option_of(*outcome, "noise of an orientation"), Not(HasSubstr("estimated from the residuals")));
  EXPECT_THAT(option_of(*outcome, "noise of an orientation"), HasSubstr("given"));
}

TEST_F(RunOrientations, SensorsThatNeitherMarkersNorAPosePlaceAreNamed) {
  auto with = beside_markers(job(), at("in/markers.c3d"));
  with.sensors.pose.clear();
  const auto model = io::read_osim(with.model).value();
  for (const auto& marker : model.markers)
    if (model.bodies[static_cast<std::size_t>(marker.body_idx)].name == "hand_r" ||
        model.bodies[static_cast<std::size_t>(marker.body_idx)].name == "ulna_r" ||
        model.bodies[static_cast<std::size_t>(marker.body_idx)].name == "radius_r")
      with.options.marker_weights.push_back({.marker = marker.name, .weight = 0.0});
  const auto outcome = run_ik(with);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              Contains(HasSubstr("markers do not determine the bodies of these sensors, which are not used; "
                                 "--calibration would say how they stand there: ")));
}

TEST_F(RunOrientations, WhatSensorsBesideMarkersNeedIsSaid) {
  auto with = beside_markers(job(), at("in/markers.c3d"));
  with.estimator = workflow::Estimator::smoother;
  EXPECT_THAT(run_ik(with).error().message, HasSubstr("the smoother cannot use orientations"));
  with = beside_markers(job(), at("in/markers.c3d"));
  with.sensors.up = "north";
  EXPECT_THAT(run_ik(with).error().message, HasSubstr("--sensors-up"));
  with = beside_markers(job(), at("in/markers.c3d"));
  with.sensors.options.facing = motion::FacingAxis{.sensor = "pelvis_imu", .axis = Eigen::Vector3d::UnitX()};
  with.sensors.pose.clear();
  EXPECT_THAT(run_ik(with).error().message, HasSubstr("give it, --calibration"));
}

}  // namespace
}  // namespace kinemark::pipeline

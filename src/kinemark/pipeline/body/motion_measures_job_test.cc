// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/body/motion_measures_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::pipeline {
namespace {

using data::Quantity;
using data::Side;
using ::testing::ElementsAre;

// Three coordinates through 3 s: a knee (angle t), a root's shift (2 t) and one that follows another.
struct Moved {
  workflow::MotionMeasured measured;
  std::vector<analysis::GaitCycle> cycles{{.side = Side::left, .start_s = 0.5, .end_s = 1.5},
                                          {.side = Side::right, .start_s = 1.0, .end_s = 2.0}};

  explicit Moved(bool torques) {
    const TimeBase time{.rate_hz = 100.0, .frames = 301};
    auto& motion = measured.motion;
    motion.time = time;
    motion.coordinates = {"knee_angle_l", "pelvis_tx", "knee_angle_l_beta"};
    motion.is_rotation = {true, false, true};
    auto& record = measured.record;
    record.time = time;
    record.names = motion.coordinates;
    record.is_rotation = {true, false, true};
    record.measured = {true, true, false};
    record.driven = {true, false, false};
    record.q.resize(301, 3);
    record.q_sd = Eigen::MatrixXd::Constant(301, 3, 0.02);
    record.determined = Eigen::MatrixX<bool>::Constant(301, 3, true);
    for (int f = 0; f < 301; ++f) {
      const double t = 0.01 * f;
      record.q.row(f) << t, 2.0 * t, t;
      motion.qd.insert(motion.qd.end(), {1.0, 2.0, 1.0});
      if (torques) motion.tau.insert(motion.tau.end(), {10.0 * t, 20.0 * t, 10.0 * t});
    }
    if (torques) record.torque_known = Eigen::MatrixX<bool>::Constant(301, 3, true);
  }
  std::vector<SheetInput> curves() {
    std::vector<SheetInput> out;
    add_motion_cycles(measured, cycles, out);
    return out;
  }
};

std::vector<std::string> names(const std::vector<SheetInput>& inputs) {
  std::vector<std::string> out;
  for (const auto& one : inputs) out.push_back(one.curves.id + " " + one.curves.context);
  return out;
}

TEST(MotionCycles, AreOfCoordinatesThatMoveByThemselves) {
  const auto out = Moved(false).curves();
  EXPECT_THAT(names(out), ElementsAre("knee_angle_l Left", "pelvis_tx Left", "pelvis_tx Right"));
  EXPECT_NEAR(out[0].curves(0, 50), 1.0, 1e-9);
  EXPECT_NEAR(out[0].curves.sd[50], 0.02, 1e-12);
  EXPECT_EQ(out[1].curves.quantity, Quantity::length);
  EXPECT_NEAR(out[2].curves(0, 0), 2.0, 1e-9);
}

TEST(MotionCycles, MomentsAndPowersWhereTorquesAreKnown) {
  const auto out = Moved(true).curves();
  EXPECT_THAT(names(out), ElementsAre("knee_angle_l Left", "pelvis_tx Left", "pelvis_tx Right",
                                      "knee_angle_l_moment Left", "knee_angle_l_power Left"));
  EXPECT_EQ(out[3].curves.quantity, Quantity::moment);
  EXPECT_NEAR(out[3].curves(0, 50), 10.0, 1e-9);  // at 1 s
  EXPECT_EQ(out[4].curves.quantity, Quantity::power);
  EXPECT_NEAR(out[4].curves(0, 50), 10.0, 1e-9);  // times a rate of 1
}

TEST(MotionCycles, WhatIsNotDeterminedIsMissing) {
  Moved moved(true);
  moved.measured.record.determined(100, 0) = false;
  moved.measured.record.torque_known(120, 0) = false;
  const auto out = moved.curves();
  EXPECT_TRUE(std::isnan(out[0].curves(0, 50)));
  EXPECT_TRUE(std::isnan(out[3].curves(0, 50)));
  EXPECT_FALSE(std::isnan(out[0].curves(0, 70)));
  EXPECT_TRUE(std::isnan(out[3].curves(0, 70)));
}

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// The coordinates that a simulated subject had.
class RunMotionMeasures : public testing::RecordedTest<IkJob> {
 protected:
  static MotionMeasuresJob measuring(const std::string& motion = "in/truth.mot") {
    MotionMeasuresJob job;
    job.motion = at(motion);
    job.model = at("in/model.osim");
    job.refits = 0;
    return job;
  }
  static Error refused(const MotionMeasuresJob& job) {
    const auto outcome = run_motion_measures(job);
    return outcome ? Error{} : outcome.error();
  }
  static const data::Measure* find(const MotionMeasuresOutcome& outcome, const std::string& id,
                                   const std::string& subject) {
    const auto at = std::ranges::find_if(outcome.measures,
                                         [&](const auto& m) { return m.id == id && m.subject == subject; });
    return at == outcome.measures.end() ? nullptr : &*at;
  }
};

TEST_F(RunMotionMeasures, RangesAreThoseOfTheMotion) {
  const auto outcome = run_motion_measures(measuring());
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto table = io::read_table(at("in/truth.mot")).value();
  const auto column = table.find("knee_angle_r");
  const auto* range = find(*outcome, "joint_range", "knee_angle_r");
  ASSERT_NE(range, nullptr);
  double low = INFINITY, high = -INFINITY;
  for (std::int64_t r = 0; r < table.rows(); ++r) {
    const double t = table.time_s[static_cast<std::size_t>(r)];
    if (t < range->start_s - 1e-6 || t > range->end_s + 1e-6) continue;
    low = std::min(low, table(r, column));
    high = std::max(high, table(r, column));
  }
  EXPECT_GT(range->start_s, table.time_s[3]) << "the ends are not measured";
  EXPECT_NEAR(range->value * 180.0 / M_PI, high - low, 0.05 * (high - low));
  EXPECT_NE(find(*outcome, "com_speed", "whole body"), nullptr);
  EXPECT_NE(find(*outcome, "angular_momentum_peak", "whole body"), nullptr);
  EXPECT_EQ(find(*outcome, "joint_work_net", "knee_angle_r"), nullptr) << "no torques were asked for";
  for (const auto& m : outcome->measures) EXPECT_TRUE(m.validate()) << m.id;
}

TEST_F(RunMotionMeasures, IntervalsOfAnIkMotionAndItsFiles) {
  ASSERT_TRUE(run_ik(IkJob(this->job("Q.mot"))));
  auto job = measuring("Q.mot");
  job.refits = 39;
  job.select = {"knee_angle_r", "ankle*_r"};
  job.couple = {"hip_flexion_r,knee_angle_r"};
  job.measures = {"joint_range", "phase_locking"};
  job.output = at("m.csv");
  const auto outcome = run_motion_measures(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->measures.size(), 3u);
  const auto& knee = outcome->measures[0];
  EXPECT_EQ(knee.subject, "knee_angle_r");
  EXPECT_EQ(knee.interval.kind, data::IntervalKind::two_sided) << knee.remark;
  const auto truth = run_motion_measures(measuring());
  const auto* exact = find(*truth, "joint_range", "knee_angle_r");
  EXPECT_LT(std::abs(knee.value - exact->value), 4.0 * knee.sd + 0.01);
  const auto text = io::read_text(at("m.csv")).value();
  EXPECT_THAT(text, HasSubstr("file,participant,session,trial,subject,context,region,cycle"));
  EXPECT_THAT(text, HasSubstr("Q.mot,,,Q,hip_flexion_r and knee_angle_r,"));
  EXPECT_EQ(outcome->inputs.size(), 3u) << "model, motion, deviations";
  EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr("no standard deviations"))));
  EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr("coordinates were low-passed at"))));
  std::filesystem::remove(at("Q_sd.sto"));
  job.output.clear();
  EXPECT_THAT(run_motion_measures(job)->warnings,
              Contains(HasSubstr("no standard deviations lie beside Q.mot (Q_sd.sto)")));
  const auto json = motion_measures_json(*outcome);
  EXPECT_EQ(json["measures"].size(), 3u);
  EXPECT_EQ(json["inputs"][0]["role"], "model");
  EXPECT_EQ(json["inputs"][0]["hash_kind"], "XXH3-64") << "as run files read it";
}

TEST_F(RunMotionMeasures, TorquesGiveWorkAndRegionsAreRows) {
  auto job = measuring();
  job.torques = true;
  job.select = {"knee_angle_r"};
  job.measures = {"joint_work_positive", "joint_moment_maximum"};
  job.regions = {"a=11-20", "b=9-22"};
  const auto outcome = run_motion_measures(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->measures.size(), 4u);
  EXPECT_EQ(outcome->measures[0].region, "a");
  EXPECT_DOUBLE_EQ(outcome->measures[0].start_s, io::read_table(at("in/truth.mot")).value().time_s[10]);
  EXPECT_GE(outcome->measures[1].value, 0.0);
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("torques are without force plates")));
  job.normalize = true;
  const auto per_mass = run_motion_measures(job);
  EXPECT_EQ(per_mass->measures[0].quantity, data::Quantity::moment_per_mass);
  EXPECT_LT(std::abs(per_mass->measures[0].value), std::abs(outcome->measures[0].value));
}

TEST_F(RunMotionMeasures, LowPassedCoordinatesHaveNoIntervals) {
  auto job = measuring();
  job.refits = 39;
  job.cutoff_hz = 6.0;
  job.measures = {"joint_range"};
  const auto outcome = run_motion_measures(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              Contains("coordinates were low-passed at 6 Hz: what that leaves of their noise is "
                       "not known, and there are no intervals"));
  EXPECT_EQ(outcome->measures[0].interval.kind, data::IntervalKind::none);
}

/// Four seconds of the simulated subject.
void simulate_longer_into(const std::filesystem::path& folder) {
  SimulateSubjectJob job;
  job.folder = folder;
  job.options.duration_s = 4.0;
  job.options.rate_hz = 60.0;
  ASSERT_TRUE(run_simulate_subject(job));
}

/// Somebody who walks for 6 s beside a plate that bears nothing.
data::Trial walk_beside_a_plate() {
  data::Trial trial;
  trial.markers = analysis::testing::KnownWalk().markers(0.0005, 3);
  data::ForcePlate plate{.type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}};
  plate.corners_in_world = {Eigen::Vector3d(9.2, 9.2, 0.0), Eigen::Vector3d(8.8, 9.2, 0.0),
                            Eigen::Vector3d(8.8, 8.8, 0.0), Eigen::Vector3d(9.2, 8.8, 0.0)};
  trial.force_plates.push_back(plate);
  trial.analog = {.names = {"fx", "fy", "fz", "mx", "my", "mz"},
                  .units = {"N", "N", "N", "Nmm", "Nmm", "Nmm"},
                  .rate_hz = 100.0,
                  .samples = trial.markers.frames()};
  trial.analog.values.assign(static_cast<std::size_t>(6 * trial.analog.samples), 0.0F);
  return trial;
}

TEST_F(RunMotionMeasures, WhereStretchesAreFromAndWhichLieBeyondTheMotionIsSaid) {
  simulate_longer_into(at("longer"));
  auto trial = walk_beside_a_plate();
  ASSERT_TRUE(io::write_markers(at("found.c3d"), trial, true));
  auto job = measuring("longer/truth.mot");
  job.measures = {"joint_range"};
  job.select = {"knee_angle_r"};
  job.between = {"Foot Strike"};
  job.forces = at("found.c3d");
  const auto found = run_motion_measures(job);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->warnings, Contains("the events of feet are those that were found in found.c3d"));
  EXPECT_THAT(found->warnings,
              Contains(HasSubstr("spans between events 'Foot Strike' reach beyond the motion and "
                                 "are left out")));
  for (const double t : {0.8, 2.0, 3.2})
    trial.events.push_back({.label = "Turn", .context = "", .time_s = t});
  ASSERT_TRUE(io::write_markers(at("own.c3d"), trial, true));
  job.between = {"Turn"};
  job.forces = at("own.c3d");
  const auto own = run_motion_measures(job);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(own->measures.size(), 2u);
  EXPECT_THAT(own->warnings, Not(Contains(HasSubstr("the events of feet are those that were found in"))));
  EXPECT_THAT(own->warnings, Not(Contains(HasSubstr("' reach beyond the motion and are left out"))));
}

TEST_F(RunMotionMeasures, RefusesInOneSentence) {
  auto job = measuring();
  job.measures = {"joint_rang"};
  EXPECT_THAT(refused(job).message, HasSubstr("no measure 'joint_rang' of a motion (nearest: joint_range"));
  job = measuring();
  job.select = {"knee_angel_r"};
  EXPECT_THAT(refused(job).message,
              HasSubstr("no coordinate 'knee_angel_r' that moves by itself (nearest: "));
  EXPECT_EQ(refused(job).code, Code::usage);
  job = measuring();
  job.couple = {"knee_angle_r"};
  EXPECT_THAT(refused(job).message, HasSubstr("'knee_angle_r' is not two coordinates"));
  job.couple = {"knee_angle_r,knee_angle_r"};
  EXPECT_THAT(refused(job).message, HasSubstr("one and another"));
  job = measuring();
  job.between = {"Foot Strike"};
  EXPECT_THAT(refused(job).message, HasSubstr("need --forces FILE.c3d"));
  job = measuring();
  job.regions = {"a=1-99999"};
  EXPECT_THAT(refused(job).message, HasSubstr("region 'a' is not within the"));
  EXPECT_EQ(refused(job).code, Code::bad_input);
  job = measuring();
  job.output = at("m.txt");
  EXPECT_EQ(refused(job).code, Code::usage);
  job = measuring();
  job.measures = {"joint_work_net"};
  EXPECT_THAT(refused(job).message, HasSubstr("torques need --forces or --torques"));
  job = measuring();
  job.model.clear();
  EXPECT_EQ(refused(job).message, "no model: give --model");
}

}  // namespace

}  // namespace kinemark::pipeline

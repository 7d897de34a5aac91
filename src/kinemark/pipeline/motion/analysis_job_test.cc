// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/analysis_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"

namespace kinemark::pipeline {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

/// Two bodies, one point, three frames; each number tells where it stands: 100 frame + 30 order + column.
motion::BodyMotion numbered() {
  motion::BodyMotion m{.time = {.rate_hz = 10.0, .t0_s = 1.0, .frames = 3}, .bodies = 2, .points = 1};
  for (int f = 0; f < 3; ++f)
    for (int order = 0; order < 3; ++order)
      for (int k = 0; k < m.columns(); ++k) m.value.push_back(100.0 * f + 30.0 * order + k);
  return m;
}

data::ModelDescription two_bodies() {
  data::ModelDescription model;
  model.bodies = {{.name = "thigh"}, {.name = "shank"}};
  return model;
}

TEST(AnalysisTables, BodiesHaveOpenSimsLabelsAndDegrees) {
  const auto m = numbered();
  const auto table = bodies_table(two_bodies(), m, m.value, {1, 0}, true, 1, true, {1, 3});
  EXPECT_EQ(table.name, "Velocities");
  EXPECT_TRUE(table.in_degrees);
  EXPECT_THAT(table.time_s, ElementsAre(DoubleEq(1.1), DoubleEq(1.2)));
  EXPECT_THAT(table.columns, ElementsAre("shank_X", "shank_Y", "shank_Z", "shank_Ox", "shank_Oy", "shank_Oz",
                                         "thigh_X", "thigh_Y", "thigh_Z", "thigh_Ox", "thigh_Oy", "thigh_Oz",
                                         "center_of_mass_X", "center_of_mass_Y", "center_of_mass_Z"));
  EXPECT_EQ(table(0, 0), 130.0);
  EXPECT_DOUBLE_EQ(table(0, 3), 133.0 * kDegPerRad);
  EXPECT_DOUBLE_EQ(table(1, 11), 241.0 * kDegPerRad);
  EXPECT_EQ(table(1, 12), 242.0) << "the mass centre is no angle";
  ASSERT_TRUE(table.validate());
}

TEST(AnalysisTables, BodiesInRadiansWithoutTheMassCentre) {
  const auto m = numbered();
  const auto table = bodies_table(two_bodies(), m, m.value, {0, 1}, false, 0, false, {0, 1});
  EXPECT_EQ(table.columns.size(), 12U);
  EXPECT_FALSE(table.in_degrees);
  EXPECT_EQ(table(0, 3), 3.0);
}

TEST(AnalysisTables, APointIsTheColumnsBehindTheMassCentre) {
  const auto m = numbered();
  const auto table = point_table(m, m.value, 0, 2, {2, 3});
  EXPECT_EQ(table.name, "PointAcceleration");
  EXPECT_THAT(table.columns, ElementsAre("state_0", "state_1", "state_2"));
  EXPECT_THAT(table.values, ElementsAre(275.0, 276.0, 277.0));
}

TEST(AnalysisTables, CoordinatesInTheirUnits) {
  data::JointMotion motion;
  motion.coordinates = {"hip", "tx", "patella"};
  motion.is_rotation = {true, false, true};
  motion.keeps_radians = {false, false, true};
  motion.time = {.rate_hz = 10.0, .frames = 2};
  const Array<double> values{1, 2, 3, 4, 5, 6};
  const auto degrees = coordinate_rates_table("Speeds", motion, values, {2, 0, 1}, true, {1, 2});
  EXPECT_THAT(degrees.columns, ElementsAre("patella", "hip", "tx"));
  EXPECT_THAT(degrees.values, ElementsAre(6.0, DoubleEq(4.0 * kDegPerRad), 5.0));
  const auto radians = coordinate_rates_table("Speeds", motion, values, {0}, false, {0, 2});
  EXPECT_THAT(radians.values, ElementsAre(1.0, 4.0));
  EXPECT_FALSE(radians.in_degrees);
}

TEST(AnalysisTables, SomeRowsOfATable) {
  data::Table table{.columns = {"a", "b"}};
  table.time_s = {0, 1, 2};
  table.values = {1, 2, 3, 4, 5, 6};
  const auto some = rows_of(table, {1, 3});
  EXPECT_THAT(some.time_s, ElementsAre(1.0, 2.0));
  EXPECT_THAT(some.values, ElementsAre(3.0, 4.0, 5.0, 6.0));
  EXPECT_EQ(rows_of(table, {1, 1}).rows(), 0);
}

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;
namespace fs = std::filesystem;

/// The coordinates that a simulated subject had, and what they do to its bodies.
class RunAnalysis : public testing::RecordedTest<IkJob> {
 protected:
  AnalysisJob analysis(const std::string& folder) {
    AnalysisJob job;
    job.motion = at("in/truth.mot");
    job.model = at("in/model.osim");
    job.output = at(folder);
    return job;
  }
  std::string refused(const AnalysisJob& job) {
    const auto outcome = run_analysis(job);
    return outcome ? std::string() : outcome.error().message;
  }
  data::Table table(const std::string& file) { return io::read_table(at(file)).value(); }
  fs::path setup(const std::string& content) {
    const auto path = at("in/setup.xml");
    EXPECT_TRUE(
        io::write_text(path, "<OpenSimDocument Version=\"40000\">" + content + "</OpenSimDocument>", true));
    return path;
  }
};

TEST_F(RunAnalysis, WritesBodiesAndCoordinatesWithDeviationsAndARecord) {
  auto job = analysis("out0");
  job.points = {{.name = "p", .body = "pelvis", .x_in_body = {0.1, 0, 0}}};
  job.torques = true;
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->written.size(), 2U * (3 + 3 + 3 + 1) + 1);
  const auto q = table("out0/truth_Kinematics_q.sto"), u = table("out0/truth_Kinematics_u.sto"),
             truth = table("in/truth.mot");
  ASSERT_EQ(q.rows(), truth.rows());
  for (const auto& name : truth.columns)
    for (std::int64_t r = 0; r < q.rows(); ++r)
      ASSERT_NEAR(q(r, q.find(name)), truth(r, truth.find(name)), 1e-6) << name << " " << r;
  // Speeds are those of the angles.
  const auto knee = q.find("knee_angle_r");
  ASSERT_GE(knee, 0);
  const double rate = outcome->time.rate_hz;
  for (std::int64_t r = 10; r + 10 < q.rows(); ++r)
    ASSERT_NEAR(u(r, knee), 0.5 * rate * (q(r + 1, knee) - q(r - 1, knee)), 0.02 * rate) << r;
  // The pelvis' point is where its body is, a tenth of a metre along its x.
  EXPECT_EQ(table("out0/truth_PointKinematics_p_pos.sto").rows(), q.rows());
  EXPECT_THAT(table("out0/truth_inverse_dynamics.sto").columns, Contains("knee_angle_r_moment"));
  EXPECT_THAT(table("out0/truth_BodyKinematics_pos_global.sto").columns, Contains("center_of_mass_Y"));
  const auto record = nlohmann::json::parse(io::read_text(at("out0/truth_analysis.json")).value());
  EXPECT_EQ(record["schema"], "kinemark.analysis");
  EXPECT_EQ(record["rows"], q.rows());
  EXPECT_EQ(record["inputs"][0]["role"], "model");
  EXPECT_EQ(record["facts"]["deviations"], "from the noise found in each coordinate");
  EXPECT_THAT(outcome->facts, Not(Contains(Pair("deviations", "from those of the motion"))));
  EXPECT_THAT(outcome->facts,
              Not(Contains(Pair("low-pass", HasSubstr("Butterworth, third order, both ways")))));
  EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr("coordinates were low-passed at"))));
  EXPECT_EQ(record["files"].size(), outcome->written.size());
}

TEST_F(RunAnalysis, DeviationsBesideTheMotionAreUsedAndWhatIsNotDeterminedHasNone) {
  ASSERT_TRUE(run_ik(IkJob(this->job("Q.mot"))));
  auto sd = table("Q_sd.sto");
  const auto knee = sd.find("knee_angle_r");
  for (std::int64_t r = 5; r < 9; ++r)
    sd.values[static_cast<std::size_t>(r) * sd.columns.size() + static_cast<std::size_t>(knee)] = NAN;
  ASSERT_TRUE(io::write_table(at("Q_sd.sto"), sd, {.force = true, .set = set_in(at("Q.mot"))}));
  auto job = analysis("out1");
  job.motion = at("Q.mot");
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->facts, Contains(Pair("deviations", "from those of the motion")));
  EXPECT_THAT(outcome->facts, Not(Contains(Pair("deviations", "from the noise found in each coordinate"))));
  const auto written = table("out1/Q_Kinematics_q_sd.sto");
  EXPECT_TRUE(std::isnan(written(6, written.find("knee_angle_r"))));
  EXPECT_GE(written(20, written.find("knee_angle_r")), sd(20, knee) * 0.999);
  const auto bodies = table("out1/Q_BodyKinematics_pos_global_sd.sto");
  EXPECT_TRUE(std::isnan(bodies(6, bodies.find("tibia_r_X"))));
  EXPECT_TRUE(std::isfinite(bodies(6, bodies.find("pelvis_X"))));
  EXPECT_TRUE(std::isfinite(table("out1/Q_BodyKinematics_pos_global.sto")(6, bodies.find("tibia_r_X"))));
}

TEST_F(RunAnalysis, WhatTheMotionLacksIsNotThereAndSaid) {
  auto motion = table("in/truth.mot");
  const auto hip = motion.find("hip_flexion_l");
  for (std::int64_t r = 3; r < 6; ++r)
    motion.values[static_cast<std::size_t>(r) * motion.columns.size() + static_cast<std::size_t>(hip)] = NAN;
  ASSERT_TRUE(io::write_table(at("in/holes.mot"), motion));
  auto job = analysis("out2");
  job.motion = at("in/holes.mot");
  job.torques = true;
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("3 cells without a number were filled")));
  const auto q = table("out2/holes_Kinematics_q.sto"),
             bodies = table("out2/holes_BodyKinematics_pos_global.sto"),
             tau = table("out2/holes_inverse_dynamics.sto");
  EXPECT_TRUE(std::isnan(q(4, q.find("hip_flexion_l"))));
  EXPECT_TRUE(std::isnan(bodies(4, bodies.find("femur_l_X"))));
  EXPECT_TRUE(std::isfinite(bodies(4, bodies.find("femur_r_X"))));
  EXPECT_TRUE(std::isfinite(bodies(7, bodies.find("femur_l_X"))));
  EXPECT_TRUE(std::isnan(tau(4, 0)));
  EXPECT_TRUE(std::isfinite(tau(7, 0)));
}

TEST_F(RunAnalysis, ASetupSaysWhatAndWhen) {
  auto job = analysis("");
  job.motion.clear();
  job.output.clear();
  job.setup = setup(R"(<AnalyzeTool name="walk"><coordinates_file>truth.mot</coordinates_file>
      <results_directory>results</results_directory><initial_time>0.105</initial_time><final_time>0.3</final_time>
      <AnalysisSet><objects><BodyKinematics name="b"><bodies>pelvis</bodies><in_degrees>false</in_degrees></BodyKinematics>
      <MuscleAnalysis name="m"/></objects></AnalysisSet></AnalyzeTool>)");
  job.first_time_s = -INFINITY;
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("'m' is passed over")));
  const auto bodies = table("in/results/walk_b_pos_global.sto");
  EXPECT_EQ(bodies.columns.size(), 6U) << "of the pelvis alone";
  EXPECT_NEAR(bodies.time_s.front(), 0.10, 1e-9) << "the row at or before the first time";
  EXPECT_NEAR(bodies.time_s.back(), 0.30, 1e-9);
  EXPECT_FALSE(fs::exists(at("in/results/walk_Kinematics_q.sto")));
}

TEST_F(RunAnalysis, OptionsTakePrecedenceOverTheSetup) {
  auto job = analysis("mine");
  job.setup = setup(R"(<InverseDynamicsTool name="id"><coordinates_file>none.mot</coordinates_file>
      <time_range>0 0.2</time_range><output_gen_force_file>tau.sto</output_gen_force_file></InverseDynamicsTool>)");
  job.first_time_s = 0.105;
  job.bodies = {"tibia_l"};
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(table("mine/tau.sto").time_s.front(), 7.0 / 60.0, 1e-9) << "a row within what was asked for";
  EXPECT_NEAR(table("mine/tau.sto").time_s.back(), 0.2, 1e-9);
  EXPECT_TRUE(fs::exists(at("mine/id_BodyKinematics_acc_global.sto")));
  EXPECT_TRUE(fs::exists(at("mine/tau_sd.sto")));
}

TEST_F(RunAnalysis, ALowPassLeavesNoDeviationsAndSmootherAngles) {
  auto job = analysis("out5");
  job.cutoff_hz = 2.0;
  const auto outcome = run_analysis(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(
      outcome->warnings,
      Contains("coordinates were low-passed at 2 Hz: what that leaves of their noise is not known, and no "
               "deviations are written"));
  EXPECT_THAT(outcome->facts, Contains(Pair("low-pass", "Butterworth, third order, both ways, 2 Hz")));
  EXPECT_THAT(outcome->facts, Contains(Pair("deviations", "none")));
  EXPECT_FALSE(fs::exists(at("out5/truth_Kinematics_q_sd.sto")));
  const auto roughness = [](const data::Table& t) {
    const auto k = t.find("knee_angle_r");
    double sum = 0.0;
    for (std::int64_t r = 2; r < t.rows(); ++r) sum += std::abs(t(r, k) - 2 * t(r - 1, k) + t(r - 2, k));
    return sum;
  };
  EXPECT_LT(roughness(table("out5/truth_Kinematics_q.sto")), roughness(table("in/truth.mot")));
}

/// The table at four times its rate, on lines between its rows.
data::Table upsampled(const data::Table& low) {
  data::Table high = low;
  high.header.clear(), high.time_s.clear(), high.values.clear();
  const auto columns = low.columns.size();
  for (std::int64_t r = 0; r < 4 * (low.rows() - 1); ++r) {
    const double share = static_cast<double>(r % 4) / 4.0;
    const auto row = static_cast<std::size_t>(r / 4);
    const auto between = [&](double a, double b) { return (1.0 - share) * a + share * b; };
    high.time_s.push_back(between(low.time_s[row], low.time_s[row + 1]));
    for (std::size_t c = 0; c < columns; ++c)
      high.values.push_back(between(low.values[row * columns + c], low.values[(row + 1) * columns + c]));
  }
  return high;
}

TEST_F(RunAnalysis, FramesThatWereMadeBetweenOthersHaveNoRates) {
  ASSERT_TRUE(run_ik(IkJob(this->job("noisy.mot"))));
  const auto low = table("noisy.mot");
  ASSERT_TRUE(io::write_table(at("made.mot"), upsampled(low)));
  auto job = analysis("out_made");
  job.motion = at("made.mot");
  const auto message = refused(job);
  EXPECT_THAT(message, HasSubstr("3 of every 4 frames were interpolated between the others, which come at"));
  EXPECT_THAT(message, HasSubstr("clean --upsampled decimate"));
  EXPECT_FALSE(fs::exists(at("out_made")));
  job.cutoff_hz = 6.0;
  EXPECT_TRUE(run_analysis(job)) << "what is low-passed follows no line between two frames";
  job = analysis("out_low");
  job.motion = at("noisy.mot");
  EXPECT_TRUE(run_analysis(job)) << "as it was measured";
}

TEST_F(RunAnalysis, NothingIsWrittenOfWhatIsRefused) {
  auto none = analysis("out6");
  none.motion.clear();
  EXPECT_THAT(refused(none), HasSubstr("no motion: give a .mot or .sto, or a --setup that names one"));
  auto job = analysis("out6");
  job.bodies = {"tail"};
  EXPECT_THAT(refused(job), HasSubstr("BodyKinematics names body 'tail', which model"));
  job = analysis("out6");
  job.points = {{.name = "p", .body = "tail"}};
  EXPECT_THAT(refused(job), HasSubstr("point 'p' names body 'tail'"));
  job.points = {{.name = "a/b", .body = "pelvis"}};
  EXPECT_THAT(refused(job), HasSubstr("cannot be the name of a file"));
  job.points = {{.name = "p", .body = "pelvis"}, {.name = "p", .body = "tibia_l"}};
  EXPECT_THAT(refused(job), HasSubstr("two results would be written as"));
  job = analysis("out6");
  job.cutoff_hz = 500.0;
  EXPECT_THAT(refused(job), HasSubstr("a cut-off of 500 Hz needs more than 1000 Hz"));
  job.cutoff_hz = -1.0;
  EXPECT_THAT(refused(job), HasSubstr("cut-off is -1 Hz"));
  job = analysis("out6");
  job.first_time_s = 90.0;
  EXPECT_THAT(refused(job), HasSubstr("no row lies between 90 and"));
  job.last_time_s = 80.0;
  EXPECT_THAT(refused(job), HasSubstr("is no range of time"));
  job = analysis("out6");
  job.setup = setup("<AnalyzeTool name=\"x\"><AnalysisSet><objects/></AnalysisSet></AnalyzeTool>");
  EXPECT_THAT(refused(job), HasSubstr("lists no analysis that is computed"));
  job.setup = setup("<AnalyzeTool name=\"x\"><results_directory>../..</results_directory></AnalyzeTool>");
  job.output.clear();
  EXPECT_THAT(refused(job), HasSubstr("results_directory"));
  EXPECT_FALSE(fs::exists(at("out6")));
  ASSERT_TRUE(run_analysis(analysis("out6")));
  EXPECT_THAT(refused(analysis("out6")), HasSubstr("--force"));
}

TEST_F(RunAnalysis, DeviationsOfAnotherMotionAreRefused) {
  auto sd = table("in/truth.mot");
  ASSERT_TRUE(io::write_table(at("in/other.mot"), sd));
  sd.columns.back() += "_x";
  ASSERT_TRUE(io::write_table(at("in/other_sd.sto"), sd));
  auto job = analysis("out7");
  job.motion = at("in/other.mot");
  EXPECT_THAT(refused(job), HasSubstr("other_sd.sto: has other columns or rows than other.mot"));
}

}  // namespace

}  // namespace kinemark::pipeline

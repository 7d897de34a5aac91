// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segments_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/workflow/segments/testing/offset_leg.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using workflow::OffsetLeg;

constexpr std::string_view kDefinition = R"toml(
title = "A knee"
[[segment]]
name = "thigh"
origin = "T1"
first = ["z", "T2 - T1"]
second = ["x", "T3 - T1"]
[[segment]]
name = "shank"
origin = "S1"
first = ["z", "S2 - S1"]
second = ["x", "S3 - S1"]
[[point]]
name = "between"
written = true
formula = "mean(T1, S1)"
[[angle]]
name = "knee"
parent = "thigh"
child = "shank"
sequence = "yxz"
components = [["flexion", "y"], ["varus", "x"], ["rotation", "z"]]
cross_talk = true
[[angle]]
name = "foot"
parent = "shank"
child = "lab"
sequence = "yxz"
components = [["flexion", "y"], ["varus", "x"], ["rotation", "z"]]
[[value]]
name = "length"
quantity = "length"
formula = "distance(T1, T2)"
)toml";

double flexion(std::int64_t f) { return 0.5 - 0.5 * std::cos(0.05 * static_cast<double>(f)); }

// A thigh that is still and a shank that flexes about an axis that is turned by `turn`; T3 is missing in
// frame 20.
class SegmentsJobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_ / "knee.toml") << kDefinition;
    write(0.0);
    job_.input = scratch_ / "walk.c3d";
    job_.definition = (scratch_ / "knee.toml").string();
    job_.output = scratch_ / "out";
    job_.doubtful = Doubtful::keep;
  }
  void write(double turn) {
    data::Trial trial;
    trial.markers = data::Trajectories::all_missing({"T1", "T2", "T3", "S1", "S2", "S3"},
                                                    {.rate_hz = 100.0, .frames = 150});
    const Eigen::Matrix3d seen = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (std::int64_t f = 0; f < 150; ++f) {
      const Eigen::Matrix3d r = seen.transpose() *
                                Eigen::AngleAxisd(flexion(f), Eigen::Vector3d::UnitY()).toRotationMatrix() *
                                seen;
      const Eigen::Vector3d at(1.0, 0.5, 0.9), below(1.0, 0.5, 0.5);
      const std::array<Eigen::Vector3d, 6> x{
          at,    at + 0.3 * Eigen::Vector3d::UnitZ(),    at + Eigen::Vector3d(0.1, 0, 0.1),
          below, below + r * Eigen::Vector3d(0, 0, 0.3), below + r * Eigen::Vector3d(0.1, 0, 0.1)};
      for (std::int64_t m = 0; m < 6; ++m) {
        trial.markers.x(f, m) = x[static_cast<std::size_t>(m)];
        trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
      }
    }
    trial.markers.set_missing(20, 2);
    ASSERT_TRUE(io::write_markers(scratch_ / "walk.c3d", trial, true));
  }

  testing_support::ScratchFolder scratch_;
  SegmentsJob job_;
};

TEST_F(SegmentsJobTest, WritesAnglesWithDeviationsAndStates) {
  job_.noise_sd_m = 0.001;
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->title, "A knee");
  EXPECT_THAT(sample_noise(outcome->motion), ::testing::Not(HasSubstr("mm a sample, median")))
      << "it was stated";
  EXPECT_FALSE(segments_outcome_json(*outcome).contains("noise"));
  const auto angles = io::read_table(job_.output / "angles.mot");
  const auto sd = io::read_table(job_.output / "angles_sd.sto");
  ASSERT_TRUE(angles && sd);
  EXPECT_TRUE(angles->in_degrees);
  const auto column = angles->find("knee_flexion");
  ASSERT_GE(column, 0);
  EXPECT_EQ(angles->columns, sd->columns);
  EXPECT_NEAR((*angles)(75, column), flexion(75) * 180.0 / std::numbers::pi, 1e-3);
  EXPECT_NEAR((*angles)(75, angles->find("length")), 0.3, 1e-6);
  EXPECT_GT((*sd)(75, column), 0.1);
  EXPECT_TRUE(std::isnan((*angles)(20, column)));
  const auto csv = io::read_text(job_.output / "angles.csv").value();
  EXPECT_THAT(csv, HasSubstr("time_s,name,component,value,sd,unit,state\n"));
  EXPECT_THAT(csv, HasSubstr("0.2,knee,flexion,,,deg,missing\n"));
  EXPECT_THAT(csv, ::testing::ContainsRegex("\n0.2,length,,0.(3|29999)[0-9]*,0.0014[0-9]*,m,measured"));
}

TEST_F(SegmentsJobTest, SaysWhatNoiseDeviationsRestOn) {
  Random random(5, 1);
  auto trial = io::read_markers(job_.input).value();
  for (std::int64_t f = 0; f < 150; ++f)
    for (std::int64_t m = 0; m < 6; ++m)
      trial.markers.x(f, m) +=
          5e-4 * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
  ASSERT_TRUE(io::write_markers(job_.input, trial, true));
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(sample_noise(outcome->motion), HasSubstr("mm a sample, median 0."));
  EXPECT_THAT(sample_noise(outcome->motion), HasSubstr("mm a sample, median"));
  const auto json = segments_outcome_json(*outcome);
  ASSERT_EQ(json["noise"].size(), 6U);
  EXPECT_NEAR(json["noise"][0]["sample_sd_mm"].get<double>(), 0.5, 0.1);
}

TEST_F(SegmentsJobTest, WritesCentresAndTheRecordingWithAngles) {
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto centres = io::read_markers(job_.output / "centres.csv");
  ASSERT_TRUE(centres) << centres.error().message;
  ASSERT_EQ(centres->markers.names, std::vector<std::string>{"between"});
  EXPECT_NEAR(centres->markers.x(3, 0).z(), 0.7, 1e-6);
  EXPECT_FALSE(centres->markers.covariance.empty());
  const auto whole = io::read_markers(job_.output / "segments.c3d");
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(whole->markers.names.back(), "between");
  EXPECT_EQ(whole->markers.state[whole->markers.index(3, 6)], data::SampleState::model_filled);
  ASSERT_THAT(whole->channels.names, Contains("knee"));
  EXPECT_EQ(whole->channels.kinds[0], data::ChannelKind::angle);
  EXPECT_NEAR(whole->channels.values[75 * 9], flexion(75) * 180.0 / std::numbers::pi, 1e-3);
  EXPECT_TRUE(std::isnan(whole->channels.values[20 * 9]));
}

TEST_F(SegmentsJobTest, ReplacesItsOwnResultsOfAnEarlierRun) {
  ASSERT_TRUE(run_segments(job_));
  auto again = job_;
  again.input = job_.output / "segments.c3d";
  again.output = scratch_ / "again";
  const auto outcome = run_segments(again);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto whole = io::read_markers(again.output / "segments.c3d");
  EXPECT_EQ(whole->markers.markers(), 7);
  EXPECT_EQ(whole->channels.names.size(), 3U);
  EXPECT_FALSE(run_segments(again)) << "without --force nothing is replaced";
}

TEST_F(SegmentsJobTest, SaysCrossTalkWhereThereIs) {
  auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome);
  ASSERT_EQ(outcome->cross_talk.size(), 1U);
  EXPECT_FALSE(outcome->cross_talk[0].second.suspicious());
  EXPECT_THAT(outcome->warnings, ::testing::Not(Contains(HasSubstr("varus follows flexion"))));
  write(0.3);
  job_.force = true;
  outcome = run_segments(job_);
  ASSERT_TRUE(outcome);
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("knee: varus follows flexion")));
  const auto json = segments_outcome_json(*outcome);
  EXPECT_TRUE(json["cross_talk"][0]["suspicious"]);
  EXPECT_EQ(json["definition"], "A knee");
  EXPECT_EQ(json["inputs"][0]["role"], "markers");
  EXPECT_EQ(json["inputs"][0]["hash_kind"], "XXH3-64") << "as run files read it";
  EXPECT_EQ(json["angles"][0]["missing"], 1);
  EXPECT_EQ(json["angles"][0]["measured"], 149);
}

TEST_F(SegmentsJobTest, NamesMarkersThatAreNotThere) {
  job_.selection.drop = {"S3"};
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("Not computed: knee, foot; there is no marker 'S3'")));
  EXPECT_EQ(outcome->motion.values.size(), 1U);
  job_.definition = "pig";
  job_.output = scratch_ / "none";
  const auto none = run_segments(job_);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("walk.c3d: nothing can be computed"));
  EXPECT_FALSE(std::filesystem::exists(job_.output));
}

TEST_F(SegmentsJobTest, RefusesWhatMakesNoSense) {
  const auto refused = [&](auto change) {
    auto job = job_;
    change(job);
    const auto outcome = run_segments(job);
    EXPECT_FALSE(outcome);
    return outcome ? std::string() : outcome.error().message;
  };
  EXPECT_THAT(refused([](auto& j) { j.axes.up = "w"; }), HasSubstr("--up: 'w' is not x, y, z"));
  EXPECT_THAT(refused([](auto& j) { j.trials = {"pointer"}; }), HasSubstr("'pointer' is not NAME=FILE"));
  EXPECT_THAT(refused([](auto& j) { j.subject = {"x=1"}; }), HasSubstr("no parameter 'x'"));
  EXPECT_THAT(refused([](auto& j) { j.definition = "nobody"; }), HasSubstr("no definition"));
  EXPECT_THAT(refused([](auto& j) { j.static_trial = "nothing.c3d"; }), HasSubstr("nothing.c3d"));
  EXPECT_THAT(refused([](auto& j) { j.noise_sd_m = -1.0; }), HasSubstr("noise"));
}

TEST_F(SegmentsJobTest, EachColumnIsASeriesWithItsDeviations) {
  job_.output.clear();
  job_.noise_sd_m = 0.001;
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto list = series_of(outcome->motion);
  const auto table = series_table(list, outcome->motion.time, "angles");
  const auto series = cycle_series(list, outcome->motion.time);
  ASSERT_EQ(series.size(), table.columns.size());
  const auto knee = std::ranges::find(series, "knee_flexion", &analysis::CycleSeries::id);
  ASSERT_NE(knee, series.end());
  EXPECT_EQ(knee->quantity, data::Quantity::angle);
  EXPECT_NEAR(knee->values[100] * 180.0 / std::numbers::pi, table(100, table.find("knee_flexion")), 1e-9);
  EXPECT_NEAR(knee->time_s[100], 1.0, 1e-12);
  EXPECT_GT(knee->sd[100], 0.0);
  EXPECT_TRUE(std::isnan(knee->values[20]));
  const auto length = std::ranges::find(series, "length", &analysis::CycleSeries::id);
  ASSERT_NE(length, series.end());
  EXPECT_EQ(length->quantity, data::Quantity::length);
}

TEST_F(SegmentsJobTest, AReportNeedsWalkingAndTheRestIsWrittenWithout) {
  job_.report = scratch_ / "gait.html";
  const auto outcome = run_segments(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("walking is not drawn: ")));
  EXPECT_FALSE(outcome->gait);
  EXPECT_FALSE(std::filesystem::exists(job_.report));
  job_.output.clear();
  EXPECT_EQ(run_segments(job_).error().code, Code::bad_input);
  job_.report.clear();
  job_.gait.sheet.norms = {"norm.csv"};
  EXPECT_EQ(run_segments(job_).error().code, Code::usage);
}

// A leg by the conventional gait model, from a file, its measures by options.
class LegJobTest : public ::testing::Test {
 protected:
  void write(const data::Trial& trial) {
    ASSERT_TRUE(io::write_markers(scratch_ / "leg.c3d", trial, true));
    job_.input = scratch_ / "leg.c3d";
    job_.definition = "pig";
    job_.noise_sd_m = 0.001;
    job_.doubtful = Doubtful::keep;
  }
  void give(const OffsetLeg& leg) {
    for (const auto& value : leg.values()) {
      const bool angle = value.name.ends_with("Rotation") || value.name.ends_with("Torsion") ||
                         value.name.ends_with("AbAdd");
      job_.subject.push_back(fmt::format("{}={}", value.name,
                                         angle ? value.value * 180.0 / std::numbers::pi : 1e3 * value.value));
    }
  }
  SegmentsOutcome run() {
    auto outcome = run_segments(job_);
    EXPECT_TRUE(outcome) << outcome.error().message;
    return outcome ? std::move(*outcome) : SegmentsOutcome{};
  }

  testing_support::ScratchFolder scratch_;
  SegmentsJob job_;
};

TEST_F(LegJobTest, SaysThatKneeRotationOfAStaticTrialContainsTheTorsion) {
  const OffsetLeg leg;
  write(leg.trial(30, false));
  give(leg);
  EXPECT_THAT(run().warnings,
              Each(Not(HasSubstr("Knee rotation of a static trial contains the tibia's torsion"))))
      << "a walk";
  job_.static_trial = job_.input;
  const auto still = run();
  EXPECT_THAT(still.warnings,
              Contains(HasSubstr("Knee rotation of a static trial contains the tibia's torsion")));
  EXPECT_THAT(
      still.warnings,
      Contains(HasSubstr("that of a walk does not: beside a walk it jumps by LTibialTorsion -17.2 deg")));
  EXPECT_TRUE(still.static_trial);
  job_.subject.push_back("LTibialTorsion=0");
  std::ranges::rotate(job_.subject, std::prev(job_.subject.end()));
  EXPECT_THAT(run().warnings,
              Each(Not(HasSubstr("Knee rotation of a static trial contains the tibia's torsion"))))
      << "without torsion nothing jumps";
}

TEST_F(LegJobTest, SaysWhatIsAssumedOfTheFoot) {
  const OffsetLeg leg;
  write(leg.trial(30, false));
  give(leg);
  EXPECT_THAT(run().warnings, Each(Not(HasSubstr(": no file tells; --subject")))) << "no static trial";
  job_.static_trial = job_.input;
  EXPECT_THAT(run().warnings, Contains(HasSubstr("FlatFoot is assumed to be 1: no file tells; --subject "
                                                 "FlatFoot=0 is the other.")));
  job_.subject.push_back("FlatFoot=0");
  EXPECT_THAT(run().warnings, Each(Not(HasSubstr(": no file tells; --subject"))));
}

TEST_F(LegJobTest, NamesModelledPointsThatStandInForMarkers) {
  const OffsetLeg leg;
  auto trial = leg.trial(30, false);
  write(trial);
  give(leg);
  const auto measured = run();
  EXPECT_THAT(measured.warnings,
              Each(Not(HasSubstr(": not measured, taken as a model of the file has them:"))));
  const auto wand = trial.markers.find("LTHI");
  ASSERT_GE(wand, 0);
  trial.channels.names = {"LTHI"};
  trial.channels.kinds = {data::ChannelKind::modeled_marker};
  trial.channels.units = {"mm"};
  trial.channels.rate_hz = 100.0;
  trial.channels.frames = 30;
  for (std::int64_t f = 0; f < 30; ++f)
    for (int k = 0; k < 3; ++k) trial.channels.values.push_back(1e3 * trial.markers.x(f, wand)[k]);
  for (std::int64_t f = 0; f < 30; ++f) trial.markers.set_missing(f, wand);
  trial.markers.names[static_cast<std::size_t>(wand)] = "Nobody";
  write(trial);
  const auto modelled = run();
  EXPECT_THAT(modelled.warnings,
              Contains("leg.c3d: not measured, taken as a model of the file has them: LTHI"));
  const auto knee = [](const SegmentsOutcome& outcome) {
    return std::ranges::find(outcome.motion.angles, "LKneeAngles", &analysis::SegmentSeries::name);
  };
  ASSERT_NE(knee(modelled), modelled.motion.angles.end());
  for (std::size_t i = 0; i < 90; ++i)
    EXPECT_NEAR(knee(modelled)->value[i], knee(measured)->value[i], 1e-4) << "a float has 7 digits";
}

TEST_F(LegJobTest, TellsWhatIsAssumed) {
  const OffsetLeg leg;
  write(leg.trial(30, false));
  give(leg);
  const auto assumed = assumed_measures(run().motion);
  EXPECT_THAT(assumed, HasSubstr("MarkerDiameter 14 mm (SD 2)"));
  EXPECT_THAT(assumed, HasSubstr("LAsisTrocanterDistance 69.94 mm (SD 10)"));
  EXPECT_THAT(assumed, Not(HasSubstr("LThighRotation"))) << "it was given";
  job_.subject.push_back("MarkerDiameter=14");
  EXPECT_THAT(assumed_measures(run().motion), Not(HasSubstr("MarkerDiameter")));
  std::erase_if(job_.subject, [](const std::string& text) { return text.starts_with("LThighRotation"); });
  EXPECT_THAT(assumed_measures(run().motion), HasSubstr("LThighRotation 0 deg (SD 15)"));
  job_.subject.push_back("LThighRotation=0");
  EXPECT_THAT(assumed_measures(run().motion), Not(HasSubstr("LThighRotation"))) << "known to be 0";
}

TEST_F(LegJobTest, ComparesWithTheFilesOwnAnglesAndTellsSoInJson) {
  const OffsetLeg leg;
  write(leg.trial(30, true));
  give(leg);
  const auto outcome = run();
  EXPECT_TRUE(outcome.comparison.agrees()) << outcome.comparison.summary();
  const auto json = segments_outcome_json(outcome);
  EXPECT_TRUE(json["comparison"]["agrees"]);
  EXPECT_FALSE(json.contains("static_trial"));
  for (auto& text : job_.subject)
    if (text.starts_with("LKneeWidth")) text = "LKneeWidth=120";
  const auto other = run();
  EXPECT_FALSE(other.comparison.agrees());
  EXPECT_THAT(other.warnings, Contains(HasSubstr("is explained by LKneeWidth")));
}

TEST_F(LegJobTest, JsonHasWhatExplainsInTheUnitsOfTheField) {
  const OffsetLeg leg;
  write(leg.trial(60, true));
  give(leg);
  for (auto& text : job_.subject)
    if (text.starts_with("LKneeWidth")) text = "LKneeWidth=120";
  const auto json = segments_outcome_json(run())["comparison"];
  EXPECT_FALSE(json["agrees"].get<bool>());
  ASSERT_EQ(json["explained_by"].size(), 1U);
  const auto& cause = json["explained_by"][0];
  EXPECT_EQ(cause["name"], "LKneeWidth");
  EXPECT_NEAR(cause["shown"].get<double>(), 102.0, 1e-3);
  EXPECT_NEAR(cause["used"].get<double>(), 120.0, 1e-9);
  EXPECT_EQ(cause["unit"], "mm");
  EXPECT_EQ(cause["from"], "--subject");
  ASSERT_EQ(json["outputs"].size(), 4U);
  for (const auto& one : json["outputs"]) {
    EXPECT_LE(one["median"].get<double>(), one["p95"].get<double>());
    EXPECT_LE(one["p95"].get<double>(), one["largest"].get<double>());
    EXPECT_EQ(one["frames"], 60);
  }
}

TEST_F(LegJobTest, JsonNamesACentreByAnotherRegression) {
  const OffsetLeg leg{.hip_forward = 0.012};
  write(leg.trial(60, true));
  give(leg);
  const auto json = segments_outcome_json(run())["comparison"];
  ASSERT_FALSE(json["explained_by"].empty());
  EXPECT_TRUE(json["explained_by"][0]["regression"].get<bool>());
}

}  // namespace
}  // namespace kinemark::pipeline

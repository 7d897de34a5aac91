// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// Two markers: RFIN reaches, RELB goes around an ellipse; events every second.
class MeasuresJobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto reach = analysis::testing::sampled(300, 100.0, analysis::testing::reach);
    const auto ellipse = analysis::testing::sampled(300, 100.0, analysis::testing::ellipse);
    data::Trial trial;
    trial.first_frame = 41;
    trial.markers = data::Trajectories::all_missing(
        {"RFIN", "RELB"}, {.rate_hz = 100.0, .t0_s = 0.4, .frames = 300, .first_number = 41});
    Random random(3, 0);
    for (std::int64_t f = 0; f < 300; ++f)
      for (int m = 0; m < 2; ++m) {
        trial.markers.x(f, m) =
            (m == 0 ? reach : ellipse).row(f).transpose() +
            5e-4 * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
        trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
      }
    for (const double t : {0.6, 1.6, 2.6}) trial.events.push_back({"Turn", "", t});
    ASSERT_TRUE(io::write_markers(recording_, trial, false));
    job_.input = recording_;
    job_.measures = {"peak_speed", "path_length"};
    job_.refits = 39;
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path recording_ = scratch_ / "signs.c3d";
  MeasuresJob job_;
};

TEST_F(MeasuresJobTest, MeasuresEveryMarkerAndWritesATable) {
  job_.output = scratch_ / "signs.csv";
  const auto outcome = run_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->measures.size(), 4u);
  EXPECT_EQ(outcome->measures[0].subject, "RFIN");
  EXPECT_NEAR(outcome->measures[1].value, 1.875 * std::hypot(0.3, 0.05) / 0.7, 0.02);
  EXPECT_THAT(io::read_text(job_.output).value(), HasSubstr("signs.c3d,,,signs,RFIN,"));
  EXPECT_EQ(outcome->written, std::vector{job_.output});
  const auto again = run_measures(job_);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::io);
}

TEST_F(MeasuresJobTest, JsonNamesTheInputAndItsChecksum) {
  job_.output = scratch_ / "signs.json";
  ASSERT_TRUE(run_measures(job_));
  const auto json = nlohmann::json::parse(io::read_text(job_.output).value());
  EXPECT_EQ(json["input"]["XXH3-64"].get<std::string>().size(), 16u);
  EXPECT_EQ(json["measures"].size(), 4u);
}

TEST_F(MeasuresJobTest, RegionsComeFromOptionsEventsAndTheJournal) {
  job_.selection.select = {"RELB"};
  job_.measures = {"path_length"};
  job_.regions = {"half=60-109"};
  job_.between = {"Turn"};
  auto journal = io::EditJournal::open(io::edits_of(recording_), io::identify_recording(recording_).value());
  ASSERT_TRUE(journal);
  ASSERT_TRUE(journal->append(
      {.kind = data::EditKind::region, .first_frame = 100, .last_frame = 199, .name = "signed"}));
  job_.edits = io::kEditsBeside;
  const auto outcome = run_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  std::vector<std::string> regions;
  for (const auto& measure : outcome->measures) regions.push_back(measure.region);
  EXPECT_EQ(regions, (std::vector<std::string>{"signed", "half", "Turn 1", "Turn 2"}));
  EXPECT_NEAR(outcome->measures[0].start_s, 0.99, 1e-9);
}

TEST_F(MeasuresJobTest, SamplesThatScreeningRejectsAreNotMeasured) {
  auto trial = io::read_markers(recording_).value();
  trial.markers.x(120, 0) += Eigen::Vector3d(0.4, 0.0, 0.0);
  const auto spoilt = scratch_ / "spoilt.c3d";
  ASSERT_TRUE(io::write_markers(spoilt, trial, false));
  job_.input = spoilt;
  const auto outcome = run_measures(job_);
  ASSERT_TRUE(outcome);
  EXPECT_THAT(outcome->warnings, ::testing::Contains(HasSubstr("RFIN")));
  EXPECT_GT(outcome->measures[1].share_not_measured, 0.0);
  EXPECT_NEAR(outcome->measures[1].value, 1.875 * std::hypot(0.3, 0.05) / 0.7, 0.03);
  job_.doubtful = Doubtful::keep;
  EXPECT_EQ(run_measures(job_)->measures[1].share_not_measured, 0.0);
}

TEST_F(MeasuresJobTest, EmgAloneIsMeasuredAndPathsNeedMarkers) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({}, {.rate_hz = 100.0, .frames = 300});
  trial.analog = {.names = {"EMG1"}, .units = {"V"}, .rate_hz = 1000.0, .samples = 3000};
  Random random(5, 0);
  for (int i = 0; i < 3000; ++i)
    trial.analog.values.push_back(1e-4 * random.gaussian() * (i % 1000 < 300 ? 5.0 : 1.0));
  const auto emg = scratch_ / "emg.c3d";
  ASSERT_TRUE(io::write_markers(emg, trial, false));
  MeasuresJob job{.input = emg};
  job.refits = 0;
  for (const auto of : {workflow::MeasuresOf::muscles, workflow::MeasuresOf::everything}) {
    job.of = of;
    const auto outcome = run_measures(job);
    ASSERT_TRUE(outcome) << outcome.error().message;
    ASSERT_FALSE(outcome->measures.empty());
    EXPECT_EQ(outcome->measures[0].subject, "EMG1");
  }
  job.of = workflow::MeasuresOf::paths;
  const auto refused = run_measures(job);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("holds 0 markers and 300 frames; need at least one of each"));
}

TEST_F(MeasuresJobTest, SaysInOneSentenceWhatIsWrong) {
  const auto says = [this](const auto& change) {
    MeasuresJob job = job_;
    change(job);
    const auto outcome = run_measures(job);
    return outcome ? std::string("no failure") : outcome.error().message;
  };
  EXPECT_THAT(says([](auto& job) { job.measures = {"peek_speed"}; }),
              HasSubstr("no measure 'peek_speed' (nearest: peak_speed"));
  EXPECT_THAT(says([](auto& job) { job.output = "a.xlsx"; }),
              HasSubstr("a.xlsx: measures are written as .csv, .json or .nwb"));
  EXPECT_THAT(says([](auto& job) { job.selection.select = {"NOSE"}; }), HasSubstr("NOSE"));
  EXPECT_THAT(says([](auto& job) { job.between = {"Strike"}; }),
              HasSubstr("no two events of one side are called 'Strike'; the recording has Turn"));
  EXPECT_THAT(says([](auto& job) { job.regions = {"late=900-950"}; }),
              HasSubstr("frames 900 to 950, lies outside the recording, whose frames are 41 to 340"));
  EXPECT_THAT(says([](auto& job) { job.input = "none.c3d"; }), HasSubstr("none.c3d"));
}

std::int64_t count(const std::string& text, const std::string& part) {
  std::int64_t out = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++out;
  return out;
}

TEST_F(MeasuresJobTest, WhereNoFootStepsEventsAndCyclesAreThoseOfTheMarkers) {
  job_.measures = {"cycle_duration", "cycle_variation", "repetition_duration"};
  job_.gait.write_events = scratch_ / "events.csv";
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  const auto outcome = run_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->rhythms.size(), 2u);
  EXPECT_TRUE(outcome->rhythms[1].periodic);
  EXPECT_THAT(outcome->warnings, ::testing::Contains(HasSubstr("RFIN: not periodic")));
  EXPECT_THAT(outcome->warnings,
              ::testing::Contains(HasSubstr(
                  "events and cycles are those of the markers' own movements, as there is no walking: ")));
  const auto events = io::read_text(job_.gait.write_events).value();
  EXPECT_EQ(count(events, ",RFIN,,,Movement Start,"), 1);
  EXPECT_EQ(count(events, ",RFIN,,,Movement End,"), 1);
  EXPECT_GE(count(events, ",RELB,,,Cycle Start,"), 2);
  const auto cycles = io::read_text(job_.gait.write_cycles).value();
  EXPECT_EQ(count(cycles, ",RFIN,speed,movement,,1,"), 101);
  EXPECT_EQ(count(cycles, ",RELB,x,cycle,,mean,"), 101);
  EXPECT_EQ(measures_outcome_json(*outcome)["rhythms"].size(), 2u);
}

TEST_F(MeasuresJobTest, EventsOfMovementsAreFoundWhereTheyAreAskedFor) {
  EXPECT_TRUE(run_measures(job_)->rhythms.empty());
  job_.gait.events = "movement";
  EXPECT_EQ(run_measures(job_)->rhythms.size(), 2u);
}

TEST_F(MeasuresJobTest, NothingIsSaidOfEventsThatNobodyAskedFor) {
  const auto plain = run_measures(job_);
  ASSERT_TRUE(plain);
  EXPECT_THAT(plain->warnings, Not(Contains(HasSubstr("Walking is not measured:"))));
  EXPECT_THAT(plain->warnings, Not(Contains(HasSubstr("movements, as there is no walking:"))));
  EXPECT_THAT(plain->warnings, Not(Contains(HasSubstr("have no cycles, such as"))));
  EXPECT_THAT(plain->warnings, Not(Contains(HasSubstr(" has no row for "))));
  job_.measures = {"peak_speed", "cadence"};
  const auto asked = run_measures(job_);
  ASSERT_TRUE(asked) << asked.error().message;
  EXPECT_THAT(asked->warnings, Contains(HasSubstr("Walking is not measured: ")));
}

TEST_F(MeasuresJobTest, PathsWithoutCyclesAreCountedOnce) {
  const auto recorded = io::read_markers(recording_).value();
  data::Trial trial;
  trial.first_frame = recorded.first_frame;
  trial.markers = data::Trajectories::all_missing({"RFIN", "RELB", "RWRI"}, recorded.markers.time);
  for (std::int64_t f = 0; f < 300; ++f)
    for (int m = 0; m < 3; ++m) {
      trial.markers.x(f, m) = recorded.markers.x(f, m % 2) + Eigen::Vector3d(m == 2 ? 0.1 : 0.0, 0.0, 0.0);
      trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
    }
  job_.input = scratch_ / "three.c3d";
  ASSERT_TRUE(io::write_markers(job_.input, trial, false));
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  const auto outcome = run_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings,
              Contains(HasSubstr("2 paths of 3 have no cycles, such as RFIN: not periodic")));
}

TEST_F(MeasuresJobTest, EventsOfOneMarkerFitIntoTheRecording) {
  job_.gait.write_events = scratch_ / "marked.c3d";
  const auto several = run_measures(job_);
  ASSERT_FALSE(several);
  EXPECT_EQ(several.error().code, Code::usage);
  EXPECT_THAT(several.error().message, HasSubstr("choose one with --select"));
  job_.selection.select = {"RFIN"};
  ASSERT_TRUE(run_measures(job_));
  const auto marked = io::read_markers(job_.gait.write_events).value();
  std::vector<std::string> labels;
  for (const auto& event : marked.events) labels.push_back(event.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"Turn", "Movement Start", "Movement End", "Turn", "Turn"}));
  EXPECT_EQ(marked.markers.markers(), 2);  // the whole recording
}

TEST_F(MeasuresJobTest, WithoutRepetitionsNoCyclesAreWritten) {
  job_.selection.select = {"RFIN"};
  job_.selection.frames = "100-200";  // within the reach
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  const auto outcome = run_measures(job_);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, Code::bad_input);
  EXPECT_THAT(outcome.error().message, HasSubstr("no movement repeats: RFIN: not periodic"));
  EXPECT_FALSE(std::filesystem::exists(job_.gait.write_cycles));
}

TEST_F(MeasuresJobTest, TablesOfNwbAndNamesOfParticipants) {
  job_.output = scratch_ / "signs.nwb";
  ASSERT_TRUE(run_measures(job_));
  EXPECT_GT(std::filesystem::file_size(job_.output), 1000u);
  job_.output = scratch_ / "named.csv";
  job_.participants_file = scratch_ / "files.tsv";
  ASSERT_TRUE(
      io::write_text(job_.participants_file, "file\tparticipant\thand\nsigns.c3d\tAnn\tleft\n", false));
  const auto named = run_measures(job_);
  ASSERT_TRUE(named);
  EXPECT_THAT(named->warnings, Not(Contains(HasSubstr(" has no row for "))));
  const auto text = io::read_text(job_.output).value();
  EXPECT_THAT(text, HasSubstr("signs.c3d,Ann,,signs,RFIN,"));
  EXPECT_THAT(text, HasSubstr(",left\n"));
  ASSERT_TRUE(io::write_text(job_.participants_file, "file\tparticipant\nother.c3d\tBob\n", true));
  job_.output.clear();
  EXPECT_THAT(run_measures(job_)->warnings, Contains(HasSubstr("files.tsv has no row for it")));
}

TEST_F(MeasuresJobTest, APageOfWalkingNamesTheAnglesThatItDrawsAndNoOthers) {
  const analysis::testing::KnownWalk walk;
  data::Trial trial;
  trial.markers = walk.markers(0.0005, 3);
  const auto page_of = [&](const std::string& name) {
    EXPECT_TRUE(io::write_markers(scratch_ / (name + ".c3d"), trial, false));
    MeasuresJob job;
    job.input = scratch_ / (name + ".c3d");
    job.report = scratch_ / (name + ".html");
    job.measures = {"gait"};
    job.refits = 0;
    const auto outcome = run_measures(job);
    EXPECT_TRUE(outcome) << outcome.error().message;
    return std::pair(io::read_text(job.report).value_or(""),
                     outcome ? outcome->warnings : std::vector<std::string>());
  };
  const auto [bare, said] = page_of("bare");
  EXPECT_THAT(said, Contains(HasSubstr("no angles are drawn: ")));
  EXPECT_THAT(bare, Not(HasSubstr("outputs of a model that the recording holds")));
  trial.channels = {.names = {"LKneeAngles", "RKneeAngles"},
                    .kinds = {data::ChannelKind::angle, data::ChannelKind::angle},
                    .units = {"deg", "deg"},
                    .rate_hz = trial.markers.time.rate_hz,
                    .frames = trial.markers.frames()};
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
    for (int c = 0; c < 6; ++c)
      trial.channels.values.push_back(30.0 + 20.0 * std::sin(5.8 * trial.markers.time.time_s(f) + c));
  const auto [modelled, then_said] = page_of("modelled");
  EXPECT_THAT(modelled, HasSubstr("outputs of a model that the recording holds"));
  EXPECT_THAT(then_said, Not(Contains(HasSubstr("no angles are drawn:"))));
}

TEST_F(MeasuresJobTest, NothingMeasurableIsAFailureAndWritesNothing) {
  job_.selection.frames = "41-60";
  job_.output = scratch_ / "short.csv";
  const auto outcome = run_measures(job_);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(
      outcome.error().message,
      HasSubstr(
          "nothing can be measured: 2 markers (RFIN, RELB) were measured in 20 frames; need 30 at least"));
  EXPECT_FALSE(std::filesystem::exists(job_.output));
}

TEST(CommandsFor, NameWhatWasMeasured) {
  using ::testing::HasSubstr;
  using ::testing::Not;
  constexpr const char *kGait = "'kinemark gait' (feet and force plates)",
                       *kPaths = "'kinemark measure' (paths of markers)";
  MeasuresOutcome outcome;
  EXPECT_EQ(commands_for(outcome), "");
  outcome.noises.emplace_back();
  EXPECT_THAT(commands_for(outcome), HasSubstr("'kinemark measure' (paths of markers)"));
  EXPECT_THAT(commands_for(outcome), Not(HasSubstr("'kinemark gait' (feet and force plates)")));
  outcome.measures.push_back({.id = "cop_path"});
  EXPECT_EQ(commands_for(outcome), std::string(kGait) + ", " + kPaths);
  outcome = {};
  outcome.emg.emplace();
  EXPECT_THAT(commands_for(outcome), HasSubstr("'kinemark emg' (electromyograms)"));
  EXPECT_THAT(commands_for(outcome), Not(HasSubstr("'kinemark measure' (paths of markers)")));
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measured_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

workflow::AskedMeasures asked_for(std::vector<std::string> measures) {
  MeasuresJob job;
  job.measures = std::move(measures);
  return asked_measures(job).value();
}

TEST(MeasureRequest, OfNothingAreAllThatApply) {
  const auto asked = asked_for({});
  EXPECT_TRUE(asked.paths && asked.walking);
  EXPECT_FALSE(asked.by_name);  // a recording without feet is none that lacks something
  EXPECT_THAT(asked.path.measures, IsEmpty());
  EXPECT_THAT(asked.gait.measures, IsEmpty());
}

TEST(MeasureRequest, AreSortedIntoPathsAndWalking) {
  const auto asked = asked_for({"cadence", "path_length", "step_width", "peak_speed"});
  EXPECT_TRUE(asked.paths && asked.walking && asked.by_name);
  EXPECT_THAT(asked.path.measures, ElementsAre("path_length", "peak_speed"));
  EXPECT_THAT(asked.gait.measures, ElementsAre("cadence", "step_width"));
}

TEST(MeasureRequest, OfOneKindLeaveTheOtherAlone) {
  const auto path = asked_for({"path_length"});
  EXPECT_TRUE(path.paths);
  EXPECT_FALSE(path.walking || path.by_name);
  const auto walking = asked_for({"stride_time"});
  EXPECT_FALSE(walking.paths);
  EXPECT_TRUE(walking.walking && walking.by_name);
}

TEST(MeasureRequest, OfACommandAreThoseThatItIsAbout) {
  const auto asked_by = [](workflow::MeasuresOf of, std::vector<std::string> measures = {}) {
    MeasuresJob job;
    job.of = of;
    job.measures = std::move(measures);
    return asked_measures(job);
  };
  const auto paths = asked_by(workflow::MeasuresOf::paths).value(),
             walking = asked_by(workflow::MeasuresOf::walking).value(),
             muscles = asked_by(workflow::MeasuresOf::muscles).value();
  EXPECT_TRUE(paths.paths);
  EXPECT_FALSE(paths.walking || paths.forces || paths.muscles);
  EXPECT_TRUE(walking.walking && walking.forces);
  EXPECT_FALSE(walking.paths || walking.muscles || walking.by_name || walking.forces_by_name);
  EXPECT_TRUE(muscles.muscles && muscles.muscles_by_name);
  EXPECT_FALSE(muscles.paths || muscles.walking || muscles.forces);
  EXPECT_TRUE(asked_by(workflow::MeasuresOf::walking, {"cadence", "plates"}).value().forces_by_name);
  EXPECT_EQ(asked_by(workflow::MeasuresOf::paths, {"cadence"}).error().message,
            "cadence is no measure of 'kinemark measure'; 'kinemark gait' measures it");
  EXPECT_EQ(asked_by(workflow::MeasuresOf::walking, {"emg"}).error().message,
            "emg is no measure of 'kinemark gait'; 'kinemark emg' measures it");
  EXPECT_EQ(asked_by(workflow::MeasuresOf::muscles, {"path_length"}).error().message,
            "path_length is no measure of 'kinemark emg'; 'kinemark measure' measures it");
  EXPECT_EQ(asked_by(workflow::MeasuresOf::paths, {"nothing"}).error().code, Code::usage);
  MeasuresJob own;
  own.gait.events = "movement";
  EXPECT_TRUE(asked_measures(own));
  own.of = workflow::MeasuresOf::walking;
  EXPECT_EQ(asked_measures(own).error().code, Code::usage);
}

TEST(MeasureRequest, AllOfWalkingIsMoreThanOneOfIt) {
  for (const auto& measures : {std::vector<std::string>{"gait"}, {"gait", "cadence"}, {"cadence", "gait"}}) {
    const auto asked = asked_for(measures);
    EXPECT_TRUE(asked.walking && asked.by_name);
    EXPECT_FALSE(asked.paths);
    EXPECT_THAT(asked.gait.measures, IsEmpty());
  }
}

TEST(MeasureRequest, EventsThatAreToBeWrittenLookForWalkingFirst) {
  MeasuresJob job;
  job.measures = {"path_length"};
  job.gait.write_events = "events.csv";
  auto asked = asked_measures(job);
  ASSERT_TRUE(asked);
  EXPECT_TRUE(asked->paths && asked->walking);
  EXPECT_FALSE(asked->by_name);  // where there is none, they are those of the markers
  job.gait.angles = "Q.mot";
  job.gait.write_cycles = "cycles.csv";
  EXPECT_TRUE(asked_measures(job)->by_name);
  job.gait = {.events = "movement", .write_events = "events.csv"};
  asked = asked_measures(job);
  ASSERT_TRUE(asked);
  EXPECT_FALSE(asked->walking);
}

TEST(MeasureRequest, MeasuresOfRepetitionsAreOfPaths) {
  MeasuresJob job;
  job.measures = {"cycle_duration"};
  const auto asked = asked_measures(job);
  ASSERT_TRUE(asked);
  EXPECT_TRUE(asked->paths);
  EXPECT_FALSE(asked->walking);
  EXPECT_THAT(asked->path.measures, ::testing::ElementsAre("cycle_duration"));
}

TEST(MeasureRequest, BothKindsHaveTheIntervalsOfTheJob) {
  MeasuresJob job;
  job.refits = 199, job.noise_sd_m = 0.002, job.level = 0.9, job.seed = 17, job.threads = 3;
  const auto asked = asked_measures(job).value();
  const auto expect_those_of_the_job = [&](const auto& options) {
    EXPECT_EQ(options.refits, 199);
    EXPECT_EQ(options.noise_sd_m, 0.002);
    EXPECT_EQ(options.level, 0.9);
    EXPECT_EQ(options.seed, 17u);
    EXPECT_EQ(options.threads, 3);
  };
  expect_those_of_the_job(asked.path);
  expect_those_of_the_job(asked.gait);
  EXPECT_FALSE(asked.path.curves);
  job.report = "page.html";
  EXPECT_TRUE(asked_measures(job)->path.curves);
}

TEST(MeasureRequest, PlatesAndMuscles) {
  MeasuresJob job;
  EXPECT_TRUE(asked_measures(job)->forces && asked_measures(job)->muscles) << "where there are any";
  EXPECT_FALSE(asked_measures(job)->forces_by_name || asked_measures(job)->muscles_by_name);
  job.measures = {"grf_peak"};
  auto asked = asked_measures(job).value();
  EXPECT_TRUE(asked.forces_by_name && !asked.muscles && !asked.paths && !asked.walking);
  EXPECT_EQ(asked.plates.measures, std::vector<std::string>{"grf_peak"});
  job.measures = {"plates", "cop_path", "emg", "emg_rms"};
  asked = asked_measures(job).value();
  EXPECT_TRUE(asked.plates.measures.empty() && asked.emg.measures.empty()) << "all of them";
  EXPECT_TRUE(asked.muscles_by_name);
  job.measures.clear();
  job.emg.write_cycles = "c.csv";
  EXPECT_TRUE(asked_measures(job)->by_name) << "cycles are of walking";
  job.measures = {"joint_range"};
  EXPECT_THAT(asked_measures(job).error().message,
              ::testing::HasSubstr("is measured of a motion, not of markers"));
}

TEST(MeasureRequest, RefuseWhatIsNone) {
  MeasuresJob job;
  job.measures = {"path_length", "cadense"};
  const auto unknown = asked_measures(job);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Code::usage);
  EXPECT_THAT(unknown.error().message, StartsWith("there is no measure 'cadense' (nearest: cadence"));
  EXPECT_THAT(unknown.error().message, ::testing::EndsWith("; --list shows them all"));
  job.measures = {"cadence"};
  job.refits = 12;
  EXPECT_EQ(asked_measures(job).error().message,
            "12 refits; need 0 (no intervals) or at least 39 for intervals of level 0.95");
  job.refits = 0;
  job.gait.events = "plate";
  EXPECT_EQ(asked_measures(job).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/marker_file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ScaleRecordingsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write("walk.c3d", {"HEEL", "TOE", "BOX"});
    write("still.c3d", {"HEEL", "TOE"});
    job_.markers = scratch_ / "walk.c3d";
    job_.static_trial = scratch_ / "still.c3d";
  }
  void write(const char* name, std::vector<std::string> markers) const {
    data::Trial trial;
    trial.markers = data::Trajectories::all_missing(std::move(markers), {.rate_hz = 100.0, .frames = 20});
    for (std::int64_t f = 0; f < 20; ++f)
      for (std::int64_t m = 0; m < trial.markers.markers(); ++m) {
        trial.markers.x(f, m) = Eigen::Vector3d(0.1, 0.01 * static_cast<double>(f), 0.2);
        trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
      }
    ASSERT_TRUE(io::write_markers(scratch_ / name, trial, false));
  }
  [[nodiscard]] Result<Recording> open(const std::filesystem::path& path) const {
    return open_scale_recording(job_, count_recordings(job_, nullptr), path);
  }

  testing_support::ScratchFolder scratch_;
  ScaleJob job_;
};

TEST_F(ScaleRecordingsTest, AreCountedOnce) {
  EXPECT_EQ(count_recordings(job_, nullptr), 2U);
  io::ScaleSetup setup;
  setup.scale_marker_file = setup.place_marker_file = job_.static_trial;
  EXPECT_EQ(count_recordings(job_, &setup), 2U);
  setup.place_marker_file = "other.trc";
  EXPECT_EQ(count_recordings(job_, &setup), 3U);
  EXPECT_EQ(count_recordings({}, nullptr), 0U);
}

TEST_F(ScaleRecordingsTest, FramesAreThoseOfTheMotion) {
  job_.selection.frames = "5-9";
  EXPECT_EQ(open(job_.markers)->trial.markers.frames(), 5);
  EXPECT_EQ(open(job_.static_trial)->trial.markers.frames(), 20);
}

TEST_F(ScaleRecordingsTest, TimesAreLeftToTheSolver) {
  job_.selection.first_time_s = 0.1;
  EXPECT_EQ(open(job_.markers)->trial.markers.frames(), 20);
}

TEST_F(ScaleRecordingsTest, NamesHoldForAllAndMayBeMissingBesideAMotion) {
  job_.selection.drop = {"BOX"};
  job_.selection.rename = {"HEEL=CALC"};
  EXPECT_THAT(open(job_.markers)->trial.markers.names, ElementsAre("CALC", "TOE"));
  EXPECT_THAT(open(job_.static_trial)->trial.markers.names, ElementsAre("CALC", "TOE"));
  job_.markers.clear();
  EXPECT_THAT(open(job_.static_trial).error().message, HasSubstr("no marker is named 'BOX'"));
}

TEST_F(ScaleRecordingsTest, OfTheSetupThoseAreReadThatAreOfUse) {
  job_.static_trial.clear();
  io::ScaleSetup setup;
  setup.scale_marker_file = scratch_ / "still.c3d";
  setup.place_marker_file = scratch_ / "walk.c3d";
  setup.place = false;
  const auto read = [&] {
    workflow::ScaleInputs inputs;
    EXPECT_TRUE(read_scale_recordings(job_, &setup, "", inputs));
    return inputs;
  };
  auto inputs = read();
  EXPECT_TRUE(inputs.motion);
  EXPECT_FALSE(inputs.still || inputs.measured) << "it neither measures nor places";
  setup.place = true;
  setup.recipe.measurements = {{.name = "foot", .pairs = {{"HEEL", "TOE"}}, .bodies = {}}};
  inputs = read();
  EXPECT_EQ(inputs.measured->name, "still.c3d");
  EXPECT_EQ(inputs.still->name, "walk.c3d");
  setup.place_marker_file = setup.scale_marker_file;
  inputs = read();
  EXPECT_FALSE(inputs.measured) << "one file for both is read once";
  EXPECT_EQ(inputs.still->where, (scratch_ / "still.c3d").string());
  job_.static_trial = scratch_ / "walk.c3d";
  inputs = read();
  EXPECT_FALSE(inputs.measured);
  EXPECT_EQ(inputs.still->name, "walk.c3d") << "the job's own takes precedence";
}

TEST_F(ScaleRecordingsTest, TheOneThatJointsWereFoundInIsKnown) {
  job_.joints = scratch_ / "skeleton.json";
  workflow::ScaleInputs inputs;
  const auto hash = io::hash_file(job_.markers)->hex;
  ASSERT_TRUE(read_scale_recordings(job_, nullptr, hash, inputs));
  EXPECT_TRUE(inputs.motion->holds_joints);
  EXPECT_FALSE(inputs.still->holds_joints);
  ASSERT_TRUE(read_scale_recordings(job_, nullptr, "", inputs));
  EXPECT_FALSE(inputs.motion->holds_joints) << "not known";
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_input.h"

#include <gmock/gmock.h>

#include <vector>

#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::pipeline {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

/// A TRC of two markers and three frames at 100 Hz.
constexpr const char* kTrc =
    "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
    "OrigDataStartFrame\tOrigNumFrames\n100\t100\t3\t2\tmm\t100\t1\t3\nFrame#"
    "\tTime\tA\t\t\tB\n\t\tX1\tY1\tZ1\t"
    "X2\tY2\tZ2\n\n1\t0.00\t0\t0\t0\t0\t0\t1000\n2\t0.01\t10\t0\t0\t0\t0\t1000\n3\t0.02\t20\t0\t0\t\t\t\n";

class LiveInputFile : public ::testing::Test {
 protected:
  LiveInputFile() { EXPECT_TRUE(io::write_text(file_, kTrc, true)); }
  testing_support::ScratchFolder scratch_;
  std::filesystem::path file_ = scratch_ / "a.trc";
};

std::string refused(const std::string& argument, Code code = Code::usage) {
  const auto source = open_live_input(argument);
  EXPECT_FALSE(source) << argument;
  if (source) return "";
  EXPECT_EQ(source.error().code, code) << argument;
  return source.error().message;
}

TEST(LiveInput, NamesAreNoFiles) {
  EXPECT_TRUE(names_live_input("sim:walk"));
  EXPECT_TRUE(names_live_input("replay:a.trc"));
  EXPECT_FALSE(names_live_input("a.trc"));
  EXPECT_FALSE(names_live_input("./sim:walk"));
}

std::vector<double> samples_of(const std::string& argument, std::uint64_t seed) {
  const auto input = open_live_input(argument, {}, seed).value();
  std::vector<double> out;
  for (stream::Frame frame; input.source->next(frame).value();)
    out.insert(out.end(), frame.x_in_world.begin(), frame.x_in_world.end());
  return out;
}

TEST(LiveInput, ASimulationHasItsModelAndWhatWasAsked) {
  const auto input = open_live_input("sim:reach?rate=60&seconds=0.5&noise=0&missing=0").value();
  EXPECT_EQ(input.title, "Simulated subject, reach");
  const auto& facts = input.source->facts();
  EXPECT_EQ(facts.frames, 30);
  EXPECT_EQ(facts.rate_hz, 60.0);
  for (stream::Frame frame; input.source->next(frame).value();)
    EXPECT_THAT(frame.state, Each(data::SampleState::measured));
  ASSERT_NE(input.model, nullptr);
  EXPECT_EQ(facts.up, Eigen::Vector3d::UnitY());
  EXPECT_EQ(facts.up_from, "the model's gravity");
}

TEST(LiveInput, ASeedGivesTheSameFrames) {
  const auto one = samples_of("sim:?seconds=0.1", 3);
  EXPECT_EQ(one.size(), 24 * 3 * open_live_input("sim:").value().source->facts().markers.size()) << "240 Hz";
  EXPECT_EQ(one, samples_of("sim:walk?seconds=0.1", 3));
  EXPECT_NE(one, samples_of("sim:?seconds=0.1", 4));
}

TEST(LiveInput, TheArmHasAModelWhereOneIsGiven) {
  const auto arm = open_live_input("sim:arm?rate=120&seconds=1&noise=0").value();
  EXPECT_EQ(arm.title, "Simulated arm of a macaque");
  EXPECT_EQ(arm.source->facts().rate_hz, 120.0);
  EXPECT_EQ(arm.source->facts().markers.size(), 16U);
  EXPECT_EQ(arm.model, nullptr);
  const auto model = testing_support::project_folder() / "models/macaque_arm.osim";
  EXPECT_NE(open_live_input("sim:arm", model).value().model, nullptr);
}

TEST(LiveInput, HoursAreOpenedAtOnce) {
  EXPECT_EQ(open_live_input("sim:arm?seconds=36000").value().source->facts().frames, 2'160'000);
  EXPECT_EQ(open_live_input("sim:walk?seconds=36000").value().source->facts().frames, 8'640'000);
}

TEST(LiveInput, WhatIsNoSourceIsASentence) {
  EXPECT_THAT(refused("sim:arm?speed=2"), HasSubstr("'speed' is no setting of it; those are rate, seconds"));
  EXPECT_THAT(refused("vicon:1"), HasSubstr("need sim:MOTION or replay:FILE"));
  EXPECT_THAT(refused("sim:run"), HasSubstr("walk"));
  EXPECT_THAT(refused("sim:walk?speed=2"), HasSubstr("'speed' is no setting of it; those are rate, seconds"));
  EXPECT_THAT(refused("sim:walk?rate"), HasSubstr("rate must be a number from 1 to 1000"));
  EXPECT_THAT(refused("sim:walk?rate=nan"), HasSubstr("rate must be"));
  EXPECT_THAT(refused("sim:walk?rate=1000&seconds=36000"),
              HasSubstr("36000000 frames; need at most 10000000"));
  EXPECT_THAT(refused("replay:"), HasSubstr("names no file"));
}

TEST_F(LiveInputFile, AReplayHasTheRateOfItsFile) {
  const auto input = open_live_input("replay:" + file_.string()).value();
  EXPECT_EQ(input.title, "a.trc");
  EXPECT_EQ(input.source->facts().rate_hz, 100.0);
  EXPECT_EQ(input.source->facts().frames, 3);
  EXPECT_EQ(input.model, nullptr);
}

TEST_F(LiveInputFile, OrTheOneThatWasAsked) {
  EXPECT_EQ(open_live_input("replay:" + file_.string() + "?rate=240").value().source->facts().rate_hz, 240.0);
  EXPECT_THAT(refused("replay:" + file_.string() + "?rate=0"), HasSubstr("rate must be"));
}

TEST_F(LiveInputFile, AFileMayHaveAQuestionMarkInItsName) {
  const auto odd = scratch_ / "a?rate=x";
  ASSERT_TRUE(io::write_text(odd, kTrc, true));
  EXPECT_EQ(open_live_input("replay:" + odd.string()).value().title, "a?rate=x");
}

TEST_F(LiveInputFile, AFileThatIsNotThereIsSaidByItsReader) {
  EXPECT_THAT(refused("replay:" + (scratch_ / "none.trc").string(), Code::io), HasSubstr("none.trc"));
}

TEST(LiveInput, ThePageNamesTasksOfLevelsBesideTheirMarkers) {
  const auto source = open_live_input("sim:walk?seconds=1").value();
  motion::TrackOptions track;
  for (const auto* level : {"orientation:thorax,LASI", "com:y=0.9m", "RASI,*"})
    track.levels.push_back(motion::TrackLevel::parse(level).value());
  const auto page = live_page(source, {}, track);
  EXPECT_THAT(page, HasSubstr(R"("orientation:thorax, LASI","com:y=0.9m","RASI, all others")"));
}

TEST_F(LiveInputFile, ThePageKnowsWhereMarkersWillBe) {
  const auto source = open_live_input("replay:" + file_.string()).value();
  const auto page = live_page(source, "folder/live.mcap");
  EXPECT_THAT(page, AllOf(HasSubstr(R"("schema":"kinemark.live")"), HasSubstr(R"("recording":"live.mcap")"),
                          HasSubstr(R"("extent_m":[[0.0,0.0,0.0],[0.02,0.0,1.0]])")));
  EXPECT_THAT(page, Not(HasSubstr("folder/")));
}

}  // namespace
}  // namespace kinemark::pipeline

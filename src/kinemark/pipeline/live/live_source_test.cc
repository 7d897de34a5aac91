// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_source.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A TRC of two markers and three frames at 100 Hz.
constexpr const char* kTrc =
    "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
    "OrigDataStartFrame\tOrigNumFrames\n100\t100\t3\t2\tmm\t100\t1\t3\nFrame#"
    "\tTime\tA\t\t\tB\n\t\tX1\tY1\tZ1\t"
    "X2\tY2\tZ2\n\n1\t0.00\t0\t0\t0\t0\t0\t1000\n2\t0.01\t10\t0\t0\t0\t0\t1000\n3\t0.02\t20\t0\t0\t\t\t\n";

class LiveSourceFile : public ::testing::Test {
 protected:
  LiveSourceFile() { EXPECT_TRUE(io::write_text(file_, kTrc, true)); }
  testing_support::ScratchFolder scratch_;
  std::filesystem::path file_ = scratch_ / "a.trc";
};

std::string refused(const std::string& argument, Code code = Code::usage) {
  const auto source = open_live_source(argument);
  EXPECT_FALSE(source) << argument;
  if (source) return "";
  EXPECT_EQ(source.error().code, code) << argument;
  return source.error().message;
}

TEST(LiveSource, NamesAreNoFiles) {
  EXPECT_TRUE(names_live_source("sim:walk"));
  EXPECT_TRUE(names_live_source("replay:a.trc"));
  EXPECT_FALSE(names_live_source("a.trc"));
  EXPECT_FALSE(names_live_source("./sim:walk"));
}

TEST(LiveSource, ASimulationHasItsModelAndWhatWasAsked) {
  const auto source = open_live_source("sim:reach?rate=60&seconds=0.5&noise=0&missing=0").value();
  EXPECT_EQ(source.title, "Simulated subject, reach");
  EXPECT_EQ(source.markers.frames(), 30);
  EXPECT_EQ(source.markers.time.rate_hz, 60.0);
  EXPECT_EQ(source.markers.count_missing(), 0);
  ASSERT_NE(source.model, nullptr);
  EXPECT_EQ(source.up, Eigen::Vector3d::UnitY());
  EXPECT_EQ(source.up_from, "the model's gravity");
}

TEST(LiveSource, ASeedGivesTheSameFrames) {
  const auto one = open_live_source("sim:?seconds=0.1", {}, 3).value();
  const auto again = open_live_source("sim:walk?seconds=0.1", {}, 3).value();
  const auto other = open_live_source("sim:?seconds=0.1", {}, 4).value();
  EXPECT_EQ(one.markers.frames(), 24) << "240 Hz";
  EXPECT_EQ(one.markers.x_in_world, again.markers.x_in_world);
  EXPECT_NE(one.markers.x_in_world, other.markers.x_in_world);
}

TEST(LiveSource, WhatIsNoSourceIsASentence) {
  EXPECT_THAT(refused("vicon:1"), HasSubstr("need sim:MOTION or replay:FILE"));
  EXPECT_THAT(refused("sim:run"), HasSubstr("walk"));
  EXPECT_THAT(refused("sim:walk?speed=2"), HasSubstr("'speed' is no setting of it; those are rate, seconds"));
  EXPECT_THAT(refused("sim:walk?rate"), HasSubstr("rate must be a number from 1 to 1000"));
  EXPECT_THAT(refused("sim:walk?rate=nan"), HasSubstr("rate must be"));
  EXPECT_THAT(refused("sim:walk?rate=1000&seconds=3600"), HasSubstr("3600000 frames; need at most 200000"));
  EXPECT_THAT(refused("replay:"), HasSubstr("names no file"));
}

TEST_F(LiveSourceFile, AReplayHasTheRateOfItsFile) {
  const auto source = open_live_source("replay:" + file_.string()).value();
  EXPECT_EQ(source.title, "a.trc");
  EXPECT_EQ(source.markers.time.rate_hz, 100.0);
  EXPECT_EQ(source.markers.frames(), 3);
  EXPECT_EQ(source.model, nullptr);
}

TEST_F(LiveSourceFile, OrTheOneThatWasAsked) {
  EXPECT_EQ(open_live_source("replay:" + file_.string() + "?rate=240").value().markers.time.rate_hz, 240.0);
  EXPECT_THAT(refused("replay:" + file_.string() + "?rate=0"), HasSubstr("rate must be"));
}

TEST_F(LiveSourceFile, AFileMayHaveAQuestionMarkInItsName) {
  const auto odd = scratch_ / "a?rate=x";
  ASSERT_TRUE(io::write_text(odd, kTrc, true));
  EXPECT_EQ(open_live_source("replay:" + odd.string()).value().title, "a?rate=x");
}

TEST_F(LiveSourceFile, AFileThatIsNotThereIsSaidByItsReader) {
  EXPECT_THAT(refused("replay:" + (scratch_ / "none.trc").string(), Code::io), HasSubstr("none.trc"));
}

TEST_F(LiveSourceFile, ThePageKnowsWhereMarkersWillBe) {
  const auto source = open_live_source("replay:" + file_.string()).value();
  const auto page = live_page(source, "folder/live.mcap");
  EXPECT_THAT(page, AllOf(HasSubstr(R"("schema":"kinemark.live")"), HasSubstr(R"("recording":"live.mcap")"),
                          HasSubstr(R"("extent_m":[[0.0,0.0,0.0],[0.02,0.0,1.0]])")));
  EXPECT_THAT(page, Not(HasSubstr("folder/")));
}

}  // namespace
}  // namespace kinemark::pipeline

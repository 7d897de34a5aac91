// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "kinemark/stages/trajectory/edits/testing/numbered_trial.h"

namespace kinemark::workflow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using trajectory::testing::numbered_trial;

/// Two subjects with the same markers, and one more.
data::Trial two_subjects() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"Ann:LASI", "Ann:RASI", "Bob:LASI", "ball"},
                                                  {.rate_hz = 100.0, .frames = 3});
  return trial;
}

data::Trial selected(const Selection& selection, data::Trial trial = numbered_trial()) {
  const auto done = take_selection(selection, trial);
  EXPECT_TRUE(done) << done.error().message;
  EXPECT_TRUE(trial.validate());
  return trial;
}

std::string refused(const Selection& selection, data::Trial trial = numbered_trial(),
                    Code code = Code::bad_input) {
  const auto names = trial.markers.names;
  const auto done = take_selection(selection, trial);
  EXPECT_FALSE(done);
  if (done) return "";
  EXPECT_EQ(done.error().code, code);
  EXPECT_EQ(trial.markers.names, names) << "the trial is as it was";
  return done.error().message;
}

TEST(Selection, NothingAskedChangesNothing) {
  EXPECT_TRUE(Selection{}.empty());
  EXPECT_THAT(selected({}).markers.names, ElementsAre("A", "B", "C"));
}

TEST(Selection, KeepsMarkersAndChannelsByNameInTheRecordingsOrder) {
  const auto trial = selected({.select = {"moment", "C", "A"}});
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "C"));
  EXPECT_THAT(trial.channels.names, ElementsAre("moment"));
  const auto fewer = selected({.select = {"?"}, .drop = {"B"}});
  EXPECT_THAT(fewer.markers.names, ElementsAre("A", "C"));
  EXPECT_THAT(fewer.channels.names, IsEmpty());
  EXPECT_THAT(refused({.drop = {"*"}}), HasSubstr("no marker is left"));
}

TEST(Selection, ASubjectsPrefixMayBeLeftOutWhereOneHasTheName) {
  EXPECT_THAT(selected({.select = {"RASI", "Bob:LASI"}}, two_subjects()).markers.names,
              ElementsAre("Ann:RASI", "Bob:LASI"));
  EXPECT_THAT(selected({.select = {"LA*"}}, two_subjects()).markers.names,
              ElementsAre("Ann:LASI", "Bob:LASI"));
  EXPECT_THAT(selected({.drop = {"Ann:*"}}, two_subjects()).markers.names, ElementsAre("Bob:LASI", "ball"));
  EXPECT_THAT(refused({.select = {"LASI"}}, two_subjects()), HasSubstr("several subjects"));
}

TEST(Selection, AnExactNameIsNoPattern) {
  auto trial = two_subjects();
  trial.markers.names = {"*1", "*11", "A1", "B"};
  EXPECT_THAT(selected({.drop = {"*1"}}, trial).markers.names, ElementsAre("*11", "A1", "B"));
  EXPECT_THAT(selected({.drop = {"?1", "*11"}}, trial).markers.names, ElementsAre("B"));
}

TEST(Selection, NewNamesCanBeExchanged) {
  const auto before = numbered_trial();
  const auto trial = selected({.rename = {"A=C", "C=A", "moment=knee"}});
  EXPECT_THAT(trial.markers.names, ElementsAre("C", "B", "A"));
  EXPECT_THAT(trial.channels.names, ElementsAre("angle", "knee"));
  EXPECT_EQ(Eigen::Vector3d(trial.markers.x(1, 0)), Eigen::Vector3d(before.markers.x(1, 0)))
      << "samples stay where they are";
  EXPECT_THAT(refused({.rename = {"A=B"}}), HasSubstr("two markers would be named 'B'"));
  EXPECT_THAT(selected({.drop = {"B"}, .rename = {"A=B"}}).markers.names, ElementsAre("B", "C"));
}

TEST(Selection, FramesByTheFilesNumbers) {
  for (const auto& [range, first, last] :
       {std::tuple{"103-105", 103, 105}, std::tuple{"108-", 108, 110}, std::tuple{"-102", 101, 102},
        std::tuple{"90-300", 101, 110}, std::tuple{"104-104", 104, 104}}) {
    const auto trial = selected({.frames = range});
    EXPECT_EQ(trial.first_frame, first) << range;
    EXPECT_EQ(trial.last_frame(), last) << range;
  }
  EXPECT_THAT(refused({.frames = "111-120"}), HasSubstr("frames 101 to 110, 1 to 1.09 s"));
}

TEST(Selection, FramesByTimeBothEndsIncluded) {
  const auto trial = selected({.first_time_s = 1.03, .last_time_s = 1.06});
  EXPECT_EQ(trial.first_frame, 104);
  EXPECT_EQ(trial.last_frame(), 107);
  EXPECT_EQ(selected({.first_time_s = 1.0301}).first_frame, 105);
  EXPECT_THAT(refused({.first_time_s = 2.0}), HasSubstr("no frame lies in the range"));
  EXPECT_THAT(refused({.last_time_s = 0.5}), HasSubstr("no frame lies in the range"));
}

TEST(Selection, WhatIsMisspeltIsAnsweredWithTheNearest) {
  EXPECT_THAT(refused({.drop = {"moments"}}), HasSubstr("no marker is named 'moments'; nearest: moment"));
  EXPECT_THAT(refused({.select = {"zzzzzzz"}}), HasSubstr("there are A, B, C, angle, moment"));
  EXPECT_THAT(refused({.select = {"Q*"}}), HasSubstr("'Q*'"));
  EXPECT_THAT(refused({.select = {"angle"}}), HasSubstr("no marker is left"));
}

TEST(Selection, WhatCanBeNoSelectionIsRefusedBeforeAnyFileIsRead) {
  for (const auto* range : {"-", "5", "9-3", "a-b", "1.5-3", "1-2-3"})
    EXPECT_THAT(refused({.frames = range}, numbered_trial(), Code::usage), HasSubstr("no range of frames"))
        << range;
  for (const auto* name : {"A", "=B", "A="})
    EXPECT_THAT(refused({.rename = {name}}, numbered_trial(), Code::usage), HasSubstr("OLD=NEW")) << name;
  EXPECT_THAT(refused({.rename = {"L*=R"}}, numbered_trial(), Code::usage), HasSubstr("several markers"));
  EXPECT_THAT(refused({.first_time_s = 2.0, .last_time_s = 1.0}, numbered_trial(), Code::usage),
              HasSubstr("no time lies"));
  EXPECT_THAT(refused({.first_time_s = 1.0, .frames = "101-"}, numbered_trial(), Code::usage),
              HasSubstr("one of them"));
}

}  // namespace
}  // namespace kinemark::workflow

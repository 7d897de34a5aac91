// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/sleap_csv.h"

#include <gmock/gmock.h>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kLabels =
    "track,frame_idx,instance.score,nose.x,nose.y,nose.score,tail.x,tail.y,tail.score\n";

Result<Keypoints> parse_rows(const std::string& rows, const KeypointsOptions& options = {}) {
  return parse_keypoints_csv(kLabels + rows, "mouse.csv", options);
}

std::string refusal(const std::string& text) {
  const auto read = parse_keypoints_csv(text, "mouse.csv");
  return read ? "read without complaint" : read.error().message;
}

TEST(SleapCsv, PointsOfEveryFrameAndNobodyWhereThereIsNoLine) {
  const auto read = parse_rows("a,2,0.9,1.5,2.5,0.9,3,4,0.8\na,0,0.9,10,20,0.95,,,\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->names, ElementsAre("nose", "tail"));
  ASSERT_EQ(read->frames(), 3);
  EXPECT_EQ(read->at(2, 0), Eigen::Vector2d(1.5, 2.5));
  EXPECT_EQ(read->at(2, 1), Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(read->at(0, 0), Eigen::Vector2d(10.0, 20.0));
  EXPECT_FALSE(read->at(0, 1).allFinite());
  EXPECT_FALSE(read->at(1, 0).allFinite());
}

TEST(SleapCsv, WhatIsUnlikelyIsNotSeenAndWhatAPersonLabelledIsSure) {
  const std::string rows = ",0,0.9,1,2,0.59,3,4,\n";
  EXPECT_FALSE(parse_rows(rows)->at(0, 0).allFinite());
  EXPECT_TRUE(parse_rows(rows, {.min_likelihood = 0.5})->at(0, 0).allFinite());
  EXPECT_TRUE(parse_rows(rows)->at(0, 1).allFinite()) << "no score: labelled by hand";
}

TEST(SleapCsv, OneTrackOfSeveralIsChosen) {
  const std::string rows = "mouse,0,1,1,2,1,3,4,1\nrat,0,1,5,6,1,7,8,1\nrat,1,1,9,9,1,9,9,1\n";
  EXPECT_THAT(refusal(kLabels + rows),
              HasSubstr("mouse.csv: shows 2 tracks; choose one with --person: 1 ('mouse'), 2 ('rat')"));
  EXPECT_EQ(parse_rows(rows, {.person = 1})->at(0, 0), Eigen::Vector2d(1.0, 2.0));
  EXPECT_FALSE(parse_rows(rows, {.person = 1})->at(1, 0).allFinite());
  EXPECT_EQ(parse_rows(rows, {.person = 2})->at(0, 1), Eigen::Vector2d(7.0, 8.0));
  EXPECT_THAT(parse_rows(rows, {.person = 3}).error().message, HasSubstr("has no track 3; it has 2"));
}

TEST(SleapCsv, ColumnsMayStandInAnyOrderAndOthersAreLeft) {
  const auto read = parse_keypoints_csv(
      "frame_idx,b.score,b.y,b.x,a.x,a.y,instance.score,tracking_score,note\n0,1,2,1,3,4,,,x\n", "n.csv");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->names, ElementsAre("b", "a"));
  EXPECT_EQ(read->at(0, 0), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(read->at(0, 1), Eigen::Vector2d(3.0, 4.0));
}

TEST(SleapCsv, WhatMakesNoSenseIsRefusedWithItsLine) {
  const std::string labels = kLabels;
  EXPECT_THAT(refusal(labels), HasSubstr("has a header but no frames"));
  EXPECT_THAT(refusal(labels + "a,0,1,1,2,1,3,4\n"), HasSubstr("line 2: has 8 cells; the header has 9"));
  EXPECT_THAT(refusal(labels + "a,-1,1,1,2,1,3,4,1\n"), HasSubstr("line 2: frame_idx is '-1'"));
  EXPECT_THAT(refusal(labels + "a,0.5,1,1,2,1,3,4,1\n"), HasSubstr("frame_idx is '0.5'"));
  EXPECT_THAT(refusal(labels + "a,0,1,one,2,1,3,4,1\n"), HasSubstr("column 4 is 'one'; need a number"));
  EXPECT_THAT(refusal(labels + "a,0,1,1,,1,3,4,1\n"), HasSubstr("point 'nose' has x but not y"));
  EXPECT_THAT(refusal(labels + "a,0,1,1,2,1,3,4,1\n\na,0,1,1,2,1,3,4,1\n"),
              HasSubstr("line 4: is of track 'a' in frame 0, as line 2 is"));
  EXPECT_THAT(refusal(labels + ",0,1,1,2,1,3,4,1\n,0,1,1,2,1,3,4,1\n"), HasSubstr("export it with tracks"));
  EXPECT_THAT(refusal("frame_idx,a.x,a.y,a.x\n"), HasSubstr("two columns are called 'a.x'"));
  EXPECT_THAT(refusal("frame_idx,a.x,b.y\n"), HasSubstr("point 'a' has no column y"));
  EXPECT_THAT(refusal(labels + "a,\"0,1,1,2,1,3,4,1\n"), HasSubstr("a quote is not closed"));
}

TEST(SleapCsv, AFrameFarAwayTakesNoMemory) {
  EXPECT_THAT(refusal(std::string(kLabels) + "a,0,1,1,2,1,3,4,1\na,900000000,1,1,2,1,3,4,1\n"),
              HasSubstr("of which almost none shows anybody"));
}

TEST(SleapCsv, IsKnownByItsLabels) {
  EXPECT_TRUE(internal::begins_sleap_csv(kLabels));
  EXPECT_FALSE(internal::begins_sleap_csv("frame_idx,a.x,a.y,a.z\n")) << "in space";
  EXPECT_FALSE(internal::begins_sleap_csv("time,a.x,a.y\n"));
  EXPECT_FALSE(internal::begins_sleap_csv("scorer,a,a\n"));
  EXPECT_FALSE(internal::begins_sleap_csv(""));
}

}  // namespace
}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/foundations/foundation_gate.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/foundations/testing/walking_body.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kNames{"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE",
                                      "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"};

/// Every marker where its name says.
data::Trajectories standing() {
  const auto body = motion::body_of_names(kNames);
  auto out = data::Trajectories::all_missing(kNames, {.rate_hz = 100.0, .frames = 5});
  for (std::int64_t f = 0; f < 5; ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const auto& marker = body.markers[static_cast<std::size_t>(m)];
      Vector3d x = marker.x_in_segment;
      for (int s = marker.segment; s >= 0; s = body.segments[at(s)].parent)
        x += body.segments[at(s)].joint_in_parent;
      out.x(f, m) = x;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

void exchange(data::Trajectories& trial, const std::string& one, const std::string& other) {
  const auto i = trial.find(one), j = trial.find(other);
  for (std::int64_t f = 0; f < trial.frames(); ++f) {
    const Vector3d kept = trial.x(f, i);
    trial.x(f, i) = trial.x(f, j);
    trial.x(f, j) = kept;
  }
}

TEST(FoundationGate, PassesACleanTrialAndSaysSo) {
  Remarks remarks;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), standing(), {}, remarks);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_TRUE(remarks.passed());
  EXPECT_TRUE(remarks.warnings.empty());
  ASSERT_EQ(remarks.gates.size(), 1);
  EXPECT_EQ(remarks.gates[0].name, "static_trial");
  EXPECT_TRUE(remarks.gates[0].passed);
  EXPECT_EQ(remarks.gates[0].value, 0.0);
  EXPECT_THAT(remarks.gates[0].sentence,
              Not(HasSubstr("shows a mirrored body: an axis of the recording is negated")));
  EXPECT_THAT(
      remarks.gates[0].sentence,
      HasSubstr("No marker of cal.c3d lies where a body cannot have it; a single one 50 mm off would be "
                "seen in "));
  EXPECT_THAT(remarks.gates[0].sentence,
              HasSubstr(fmt::format("{:.0f} % of markers and directions.", 100.0 * judged->seen_at_50_mm)));
  EXPECT_THAT(remarks.gates[0].sentence, Not(HasSubstr("Everything below takes it as it is")));
  EXPECT_EQ(judged->judged.size(), kNames.size());
  EXPECT_TRUE(judged->findings.empty());
  EXPECT_EQ(judged->movements, 0);
}

TEST(FoundationGate, SaysWhereTheTrialMoves) {
  const auto body = motion::body_of_names(kNames);
  auto trial = data::Trajectories::all_missing(kNames, {.rate_hz = 100.0, .frames = 20});
  for (std::int64_t f = 0; f < trial.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers(); ++m) {
      trial.x(f, m) = standing().x(0, m);
      if (f >= 10 && kNames[at(m)] == "LANK") trial.x(f, m) += Vector3d(-0.2, 0.2, 0.0);
      trial.state[trial.index(f, m)] = data::SampleState::measured;
    }
  Remarks remarks;
  ASSERT_TRUE(judge_static_trial("cal.c3d", body, trial, {}, remarks));
  ASSERT_FALSE(remarks.warnings.empty());
  EXPECT_THAT(remarks.warnings[0], HasSubstr("cal.c3d is not still"));
  EXPECT_THAT(remarks.warnings[0],
              HasSubstr("a posture that is taken from all of it is a mean of different ones"));
}

TEST(FoundationGate, MissesAnExchangeAndNamesThePair) {
  auto trial = standing();
  exchange(trial, "LTOE", "LHEE");
  Remarks remarks;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), trial, {}, remarks);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_FALSE(remarks.passed());
  ASSERT_EQ(remarks.warnings.size(), 1);
  EXPECT_THAT(remarks.warnings[0], HasSubstr("LHEE and LTOE are exchanged in cal.c3d"));
  EXPECT_THAT(remarks.warnings[0], HasSubstr("Everything below takes it as it is; label it again or leave"));
  EXPECT_THAT(remarks.warnings[0], Not(HasSubstr("lies where a body cannot have it")));
  EXPECT_EQ(remarks.gates[0].sentence, remarks.warnings[0]);
  EXPECT_EQ(remarks.gates[0].value, 1.0);
  ASSERT_EQ(judged->findings.size(), 1U);
  EXPECT_EQ(judged->findings[0].partner, "LTOE");
}

TEST(FoundationGate, SaysThatTwoRecordingsContradictEachOtherWhereTheMovementMayBeWrong) {
  const auto body = motion::body_of_names(kNames);
  auto walk = motion::testing::walking_body(kNames, 60);
  const data::Trajectories* const movement = &walk;
  for (std::int64_t f = 0; f < walk.frames(); ++f) walk.x(f, walk.find("LASI")) += Vector3d(0.0, 0.09, 0.0);
  Remarks remarks;
  const auto judged = judge_static_trial("cal.c3d", body, standing(), std::span(&movement, 1), remarks);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_FALSE(remarks.passed());
  ASSERT_EQ(remarks.warnings.size(), 1U);
  EXPECT_THAT(remarks.warnings[0],
              HasSubstr("The static trial and the movement beside it contradict each other: LASI lies"));
  EXPECT_THAT(remarks.warnings[0], Not(HasSubstr("The static trial cannot be built on")));
  auto trial = standing();
  exchange(trial, "LTOE", "LHEE");
  Remarks other;
  ASSERT_TRUE(judge_static_trial("cal.c3d", body, trial, {}, other));
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_THAT(other.warnings[0], HasSubstr("The static trial cannot be built on"));
  EXPECT_THAT(other.warnings[0],
              Not(HasSubstr("The static trial and the movement beside it contradict each other")));
}

TEST(FoundationGate, NamesEachOfTwoExchanges) {
  auto trial = standing();
  exchange(trial, "LTOE", "LHEE");
  exchange(trial, "RASI", "RPSI");
  Remarks remarks;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), trial, {}, remarks);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_EQ(judged->findings.size(), 2U);
  ASSERT_EQ(remarks.warnings.size(), 1U) << "one gate, one sentence";
  EXPECT_THAT(remarks.warnings[0], HasSubstr("LHEE and LTOE are exchanged"));
  EXPECT_THAT(remarks.warnings[0], HasSubstr("RASI and RPSI are exchanged"));
  EXPECT_FALSE(remarks.passed());
}

TEST(FoundationGate, OfARecordingIsMissedWhereItHoldsAnExchange) {
  const auto body = motion::body_of_names(kNames);
  auto walk = motion::testing::walking_body(kNames, 60);
  Remarks remarks;
  const auto sound = judge_recording("walk.c3d", walk, "nothing is computed", remarks);
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_TRUE(sound->empty());
  EXPECT_TRUE(remarks.gates.empty());
  EXPECT_TRUE(remarks.warnings.empty());
  exchange(walk, "LTOE", "LHEE");
  ASSERT_TRUE(judge_recording("walk.c3d", walk, "nothing is computed", remarks));
  EXPECT_FALSE(remarks.passed());
  ASSERT_EQ(remarks.warnings.size(), 1U);
  EXPECT_EQ(remarks.warnings[0],
            "LHEE and LTOE are exchanged in walk.c3d; nothing is computed: label them again.");
  // Beside it a sound static trial is not accused once the walk is named as it should be.
  exchange(walk, "LTOE", "LHEE");
  const data::Trajectories* const movement = &walk;
  Remarks beside;
  ASSERT_TRUE(judge_static_trial("cal.c3d", body, standing(), std::span(&movement, 1), beside));
  EXPECT_TRUE(beside.passed());
}

void negate(data::Trajectories& trial, int axis) {
  for (std::int64_t f = 0; f < trial.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers(); ++m) trial.x(f, m)[axis] *= -1.0;
}

TEST(FoundationGate, SaysThatABodyIsMirroredAndWhatElseSeemsAlike) {
  for (int axis = 0; axis < 3; ++axis) {
    auto trial = standing();
    negate(trial, axis);
    Remarks remarks;
    const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), trial, {}, remarks);
    ASSERT_TRUE(judged) << judged.error().message;
    EXPECT_TRUE(judged->mirrored);
    EXPECT_TRUE(judged->findings.empty());
    EXPECT_FALSE(remarks.passed());
    EXPECT_THAT(remarks.gates[0].sentence,
                HasSubstr("cal.c3d shows a mirrored body: an axis of the recording is negated"));
    EXPECT_THAT(remarks.gates[0].sentence, HasSubstr("or all names of left and right are exchanged"));
  }
}

TEST(FoundationGate, NoPairIsBlamedForAMirroredWalk) {
  auto walk = motion::testing::walking_body(kNames, 60);
  negate(walk, 2);
  Remarks remarks;
  ASSERT_TRUE(judge_recording("walk.c3d", walk, "nothing is computed", remarks));
  EXPECT_TRUE(remarks.passed());
  note_mirrored("walk.c3d", motion::body_of_names(kNames), walk, remarks.warnings);
  EXPECT_EQ(remarks.warnings.size(), 1U);
}

TEST(FoundationGate, AllNamesOfBothSidesExchangedLookLikeAMirror) {
  auto trial = standing();
  for (const std::string stem : {"ASI", "PSI", "KNE", "ANK", "HEE", "TOE"})
    exchange(trial, "L" + stem, "R" + stem);
  std::vector<std::string> warnings;
  note_mirrored("walk.c3d", motion::body_of_names(kNames), trial, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("walk.c3d shows a mirrored body"));
}

TEST(FoundationGate, NothingIsSaidOfARightBodyOrOneExchangeOrTooFewMarkers) {
  std::vector<std::string> warnings;
  auto trial = standing();
  note_mirrored("walk.c3d", motion::body_of_names(kNames), trial, warnings);
  exchange(trial, "LASI", "RASI");
  note_mirrored("walk.c3d", motion::body_of_names(kNames), trial, warnings);
  auto few = data::Trajectories::all_missing({"LASI", "RASI", "LPSI"}, {.rate_hz = 100.0, .frames = 3});
  note_mirrored("walk.c3d", motion::body_of_names(few.names), few, warnings);
  note_mirrored("walk.c3d", motion::body_of_names({}), few, warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(FoundationGate, IsNotThereWhereNothingCanBeJudged) {
  Remarks remarks;
  const auto nobody = data::Trajectories::all_missing({"a", "b"}, {.rate_hz = 100.0, .frames = 2});
  ASSERT_TRUE(judge_static_trial("cal.c3d", motion::body_of_names(nobody.names), nobody, {}, remarks));
  EXPECT_TRUE(remarks.gates.empty());
  EXPECT_TRUE(remarks.warnings.empty());
}

TEST(SideByBody, IsThatOfTheNamesUnlessTheyAreExchangedOrNobodys) {
  auto walk = motion::testing::walking_body(kNames, 60);
  const auto left = walk.find("LKNE"), right = walk.find("RKNE"), front = walk.find("LASI"),
             back = walk.find("LPSI");
  EXPECT_EQ(side_by_body(walk, left, right), 1);
  EXPECT_EQ(side_by_body(walk, front, back), 1);
  exchange(walk, "LKNE", "RKNE");
  EXPECT_EQ(side_by_body(walk, left, right), -1);
  EXPECT_EQ(side_by_body(walk, front, back), 1);
  walk.names[at(front)] = "Wand";
  EXPECT_EQ(side_by_body(walk, front, back), 0) << "no landmark";
}

}  // namespace
}  // namespace kinemark::workflow

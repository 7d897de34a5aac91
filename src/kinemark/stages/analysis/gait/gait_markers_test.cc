// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/analysis/gait/feet_by_place.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using Names = std::vector<std::string>;
using Indices = std::vector<std::int64_t>;

// Markers of these names, all seen, each at a place of its own.
data::Trajectories named(const Names& names) {
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = 50});
  for (std::int64_t f = 0; f < 50; ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = Eigen::Vector3d(0.01 * static_cast<double>(f), 0.0, 0.1 * static_cast<double>(m));
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}
void hide(data::Trajectories& markers, std::int64_t m, std::int64_t from = 0) {
  for (std::int64_t f = from; f < markers.frames(); ++f) markers.set_missing(f, m);
}

TEST(GaitMarkers, AreFoundUnderUsualNames) {
  for (const auto& names :
       {Names{"LHEE", "LTOE", "RHEE", "RTOE", "LPSI", "RPSI"},
        Names{"L.Heel", "L.Toe", "R.Heel", "R.Toe", "V.Sacral"},
        Names{"L.Heel", "L.Toe.Tip", "R.Heel", "R.Toe.Tip", "L.PSIS", "R.PSIS"},
        Names{"Anna:LHEE", "Anna:LTOE", "Anna:RHEE", "Anna:RTOE", "Anna:LBWT", "Anna:RBWT"},
        Names{"L_FCC", "L_FM1", "R_FCC", "R_FM1", "L_IPS", "R_IPS"},
        Names{"l heel", "l met", "r heel", "r met", "sacrum"},
        Names{"LxHeel", "LxToe1", "RxHeel", "RxToe1", "sacrum"},
        Names{"HeelL", "ToeL", "HeelR", "ToeR", "sacrum"},
        Names{"LCAL", "LMT2", "RCAL", "RMT2", "LASI", "RASI"},
        Names{"L_calc_study", "L_toe_study", "r_calc_study", "r_toe_study", "r.PSIS_study", "L.PSIS_study"},
        Names{"LHeel", "LBigToe", "RHeel", "RBigToe", "MidHip"}}) {
    const auto found = find_gait_markers(named(names));
    ASSERT_TRUE(found) << names[0];
    EXPECT_EQ(found->foot(Side::left).heel, 0) << names[0];
    EXPECT_EQ(found->foot(Side::left).toe, 1) << names[0];
    EXPECT_EQ(found->foot(Side::right).heel, 2) << names[0];
    EXPECT_EQ(found->foot(Side::right).toe, 3) << names[0];
    EXPECT_EQ(found->foot(Side::left).set, FootSet::heel_and_toe);
    EXPECT_EQ(found->pelvis.size(), names.size() - 4) << names[0];
    EXPECT_TRUE(found->notes.empty()) << names[0] << found->notes.front();
  }
}

TEST(GaitMarkers, PelvisIsAllOfItsMarkersWithFrontAndBack) {
  const auto found =
      find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE", "LASI", "RASI", "LPSI", "RPSI", "SACR"}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pelvis, (Indices{4, 5, 6, 7, 8}));
  EXPECT_EQ(found->front, (Indices{4, 5}));
  EXPECT_EQ(found->back, (Indices{6, 7}));
  const auto sacrum = find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE", "LASI", "RASI", "SACR"}));
  EXPECT_EQ(sacrum->back, (Indices{6}));
}

TEST(GaitMarkers, AnAnkleStandsForAHeelAndSaysSo) {
  const auto found = find_gait_markers(named({"LANK", "LTOE", "RHEE", "RTOE", "SACR"}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->foot(Side::left).heel, 0);
  EXPECT_EQ(found->foot(Side::left).set, FootSet::ankle_and_toe);
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_EQ(found->notes[0], "left foot: no marker of the heel is used, LANK of the ankle stands for it");
}

TEST(GaitMarkers, AHeelThatIsNeverSeenGivesWayToTheAnkle) {
  auto markers = named({"LHEE", "LANK", "LTOE", "RHEE", "RTOE", "SACR"});
  hide(markers, 0);
  const auto found = find_gait_markers(markers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->foot(Side::left).heel, 1);
  EXPECT_NE(
      found->notes[0].find("left foot: LHEE is hidden from 0.00 to 0.49 s; no marker of the heel is used"),
      std::string::npos)
      << found->notes[0];
}

TEST(GaitMarkers, OfTwoNamesTheOneThatIsSeenIsTaken) {
  auto markers = named({"LHEE", "LCAL", "LTOE", "RHEE", "RTOE", "SACR"});
  EXPECT_EQ(find_gait_markers(markers)->foot(Side::left).heel, 0);
  hide(markers, 0, 20);
  const auto other = find_gait_markers(markers);
  EXPECT_EQ(other->foot(Side::left).heel, 1);
  ASSERT_EQ(other->notes.size(), 1u);
  EXPECT_EQ(other->notes[0], "left foot: LHEE is hidden from 0.20 to 0.49 s; LCAL and LTOE are used");
}

TEST(GaitMarkers, SingleLettersAreBelievedInPairsOnly) {
  EXPECT_EQ(find_gait_markers(named({"LA", "LD", "RA", "RD", "SACR"}))->foot(Side::right).toe, 3);
  const auto alone = find_gait_markers(named({"LA", "LTOE", "RHEE", "RTOE", "SACR"}));
  EXPECT_EQ(alone->foot(Side::left).set, FootSet::toe_alone);
}

TEST(GaitMarkers, OneFootIsMeasuredAloneAndSaysSo) {
  const auto found = find_gait_markers(named({"RHEE", "RTOE", "SACR"}));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->foot(Side::left).complete());
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_EQ(found->notes[0], "there is no marker of the left foot that is seen; that foot is not measured");
}

TEST(GaitMarkers, WithoutAnythingButFeetNothingTellsWhichWayIsUp) {
  const auto found = find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE"}));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::bad_input);
  EXPECT_NE(found.error().message.find("no marker besides those of the feet"), std::string::npos);
}

TEST(GaitMarkers, WithoutFeetTheSentenceSaysSo) {
  const auto found = find_gait_markers(named({"Head", "C7"}));
  ASSERT_FALSE(found);
  EXPECT_THAT(
      found.error().message,
      ::testing::AllOf(HasSubstr("no marker of a foot is found"),
                       HasSubstr("there are Head and C7: name those of the feet with --gait-marker")));
}

TEST(GaitMarkers, OfTwoPeopleOneIsTakenAndTheOtherNamed) {
  auto markers = named({"Ann:LHEE", "Ann:LTOE", "Ann:RHEE", "Ann:RTOE", "Ann:SACR", "Bob:LHEE", "Bob:LTOE",
                        "Bob:RHEE", "Bob:RTOE", "Bob:SACR"});
  const auto first = find_gait_markers(markers);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->person, "Ann");
  EXPECT_EQ(first->foot(Side::left).heel, 0);
  EXPECT_NE(first->notes[0].find("2 people: walking is that of Ann, not of Bob"), std::string::npos);
  const std::vector<MarkerRole> bob{{"left_heel", "Bob:LHEE"}};
  EXPECT_EQ(find_gait_markers(markers, bob)->foot(Side::right).toe, 8);
  hide(markers, 0, 20);
  EXPECT_EQ(find_gait_markers(markers)->person, "Bob");
  // One person among markers without a name is one person.
  EXPECT_EQ(find_gait_markers(named({"Ann:LHEE", "Ann:LTOE", "Ann:RHEE", "Ann:RTOE", "*12"}))->person, "");
}

TEST(GaitMarkers, GivenNamesTakePrecedence) {
  const Names names{"RFT1", "RFT2", "LFT1", "LFT2", "LHEE", "PV1"};
  const std::vector<MarkerRole> roles{{"right_heel", "RFT1"},
                                      {"right_toe", "RFT2"},
                                      {"left_heel", "LFT1"},
                                      {"left_toe", "LFT2"},
                                      {"sacrum", "PV1"}};
  const auto found = find_gait_markers(named(names), roles);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->foot(Side::left).heel, 2);
  EXPECT_EQ(found->pelvis, (Indices{5}));
}

TEST(GaitMarkers, WrongRolesAndNamesAreRefused) {
  const std::vector<MarkerRole> no_role{{"left_knee", "LHEE"}}, no_name{{"left_heel", "LHEEL"}};
  const auto role = find_gait_markers(named({"LHEE"}), no_role),
             name = find_gait_markers(named({"LHEE"}), no_name);
  ASSERT_FALSE(role || name);
  EXPECT_EQ(role.error().code, Code::usage);
  EXPECT_NE(role.error().message.find("left_ankle"), std::string::npos);
  EXPECT_EQ(name.error().code, Code::bad_input);
  EXPECT_NE(name.error().message.find("nearest: LHEE"), std::string::npos) << name.error().message;
}

// A walker with unknown names: feet, knees, a pelvis, a head.
data::Trajectories unnamed_walker(const Names& names) {
  const auto known = testing::KnownWalk{}.markers(0.0003, 3);
  auto out = data::Trajectories::all_missing(names, known.time);
  for (std::int64_t f = 0; f < known.frames(); ++f)
    for (std::int64_t m = 0; m < 9; ++m) {
      const Eigen::Vector3d pelvis = known.x(f, 4);
      if (m < 5) out.x(f, m) = Eigen::Vector3d(known.x(f, m));
      if (m == 5) out.x(f, m) = 0.5 * (Eigen::Vector3d(known.x(f, 0)) + pelvis);
      if (m == 6) out.x(f, m) = 0.5 * (Eigen::Vector3d(known.x(f, 2)) + pelvis);
      if (m > 6) out.x(f, m) = pelvis + Eigen::Vector3d(0.0, m == 7 ? 0.1 : -0.1, 0.7);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}
const Indices kAll{0, 1, 2, 3, 4, 5, 6, 7, 8};

TEST(FeetByPlace, AreTheLowestPairsThatKeepTheirDistance) {
  const auto found =
      find_feet_by_place(unnamed_walker({"LQ1", "LQ2", "RQ1", "RQ2", "P", "LQ3", "RQ3", "LQ4", "RQ4"}), kAll);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->sides_known);
  EXPECT_EQ(found->feet[0], (std::array<std::int64_t, 2>{0, 1}));
  EXPECT_EQ(found->feet[1], (std::array<std::int64_t, 2>{2, 3}));
}

TEST(FeetByPlace, AreTwoGroupsWhereNoNamesPair) {
  const auto found = find_feet_by_place(unnamed_walker({"1", "2", "3", "4", "5", "6", "7", "8", "9"}), kAll);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->sides_known);
  for (const auto& foot : found->feet) {
    EXPECT_LT(std::max(foot[0], foot[1]), 4);
    EXPECT_EQ(foot[0] / 2, foot[1] / 2);
  }
  EXPECT_NE(found->feet[0][0] / 2, found->feet[1][0] / 2);
}

TEST(GaitMarkers, WhatStandsForWhatIsSaidWhereItDoesAlone) {
  const auto whole = find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE", "SACR"}))->notes;
  EXPECT_THAT(whole, Not(Contains(HasSubstr("(--gait-marker with a marker of another one takes that one)"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("the one without a name"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("no names of feet are known here: by their place, "))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("; no name tells which is left"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr(" % of the frames"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr(" foot that is seen; that foot is not measured"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("no marker of the heel is used, "))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr(" stands for the whole foot"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("no marker of the pelvis is named; the mean of the "))));

  EXPECT_THAT(find_gait_markers(named({"LTOE", "RHEE", "RTOE", "SACR"}))->notes,
              Contains("left foot: no marker of the heel or ankle is used, LTOE stands for the whole foot"));
  EXPECT_THAT(find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE", "X1", "X2"}))->notes,
              Contains("no marker of the pelvis is named; the mean of the 2 others stands for it"));
  auto flickers = named({"LHEE", "LCAL", "LTOE", "RHEE", "RTOE", "SACR"});
  for (std::int64_t f = 0; f < 50; f += 2) flickers.set_missing(f, 0);
  EXPECT_THAT(find_gait_markers(flickers)->notes,
              Contains("left foot: LHEE is seen in 50 % of the frames; LCAL and LTOE are used"));
  const auto two = find_gait_markers(named({"LHEE", "LTOE", "RHEE", "RTOE", "SACR", "Bob:LHEE", "Bob:LTOE"}));
  EXPECT_THAT(two->notes, Contains(HasSubstr("walking is that of the one without a name, not of Bob "
                                             "(--gait-marker with a marker of another one takes that one)")));
}

TEST(GaitMarkers, FeetByTheirPlaceAreNamedAsSuch) {
  EXPECT_THAT(find_gait_markers(unnamed_walker({"1", "2", "3", "4", "5", "6", "7", "8", "9"}))->notes,
              Contains(::testing::AllOf(HasSubstr("no names of feet are known here: by their place, "),
                                        HasSubstr("; no name tells which is left"))));
  EXPECT_THAT(
      find_gait_markers(unnamed_walker({"LQ1", "LQ2", "RQ1", "RQ2", "P", "LQ3", "RQ3", "LQ4", "RQ4"}))->notes,
      ::testing::AllOf(
          Contains(HasSubstr("; to change that: --gait-marker left_heel=LQ1 --gait-marker left_toe=LQ2 "
                             "--gait-marker right_heel=RQ1 --gait-marker right_toe=RQ2")),
          Not(Contains(HasSubstr("; no name tells which is left")))));
}

TEST(FeetByPlace, AreNotFoundOnAHand) {
  EXPECT_FALSE(find_feet_by_place(named({"a", "b", "c"}), Indices{0, 1, 2}));
}

}  // namespace
}  // namespace kinemark::analysis

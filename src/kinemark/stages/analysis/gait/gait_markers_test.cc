// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_markers.h"

#include <gtest/gtest.h>

namespace kinemark::analysis {
namespace {

using data::Side;
using Names = std::vector<std::string>;

TEST(GaitMarkers, AreFoundUnderUsualNames) {
  for (const auto& names :
       {Names{"LHEE", "LTOE", "RHEE", "RTOE", "LPSI", "RPSI"},
        Names{"L.Heel", "L.Toe", "R.Heel", "R.Toe", "V.Sacral"},
        Names{"L.Heel", "L.Toe.Tip", "R.Heel", "R.Toe.Tip", "R.PSIS", "L.PSIS"},
        Names{"Anna:LHEE", "Anna:LTOE", "Anna:RHEE", "Anna:RTOE", "Anna:LBWT", "Anna:RBWT"},
        Names{"L_FCC", "L_FM1", "R_FCC", "R_FM1", "L_IPS", "R_IPS"},
        Names{"l heel", "l met", "r heel", "r met", "sacrum"},
        Names{"LCAL", "LMT2", "RCAL", "RMT2", "LASI", "RASI"},
        Names{"LHeel", "LBigToe", "RHeel", "RBigToe", "MidHip"}}) {
    const auto found = find_gait_markers(names);
    ASSERT_TRUE(found) << names[0];
    EXPECT_EQ(found->foot(Side::left).heel, 0) << names[0];
    EXPECT_EQ(found->foot(Side::left).toe, 1) << names[0];
    EXPECT_EQ(found->foot(Side::right).heel, 2) << names[0];
    EXPECT_EQ(found->foot(Side::right).toe, 3) << names[0];
    ASSERT_EQ(found->pelvis.size(), 1u) << names[0];
    EXPECT_EQ(found->pelvis[0].size(), names.size() - 4) << names[0];
    EXPECT_TRUE(found->notes.empty()) << names[0];
  }
}

TEST(GaitMarkers, PelvisHasSetsBestFirst) {
  const auto found =
      find_gait_markers({"LHEE", "LTOE", "RHEE", "RTOE", "LASI", "RASI", "LPSI", "RPSI", "SACR"});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pelvis, (std::vector<std::vector<std::int64_t>>{{8}, {6, 7}, {4, 5}}));
}

TEST(GaitMarkers, AnAnkleStandsForAHeelAndSaysSo) {
  const auto found = find_gait_markers({"LANK", "LTOE", "RHEE", "RTOE"});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->foot(Side::left).heel, 0);
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_EQ(found->notes[0], "there is no marker of the left heel; that of the ankle, LANK, stands for it");
}

TEST(GaitMarkers, OneFootIsMeasuredAlone) {
  const auto found = find_gait_markers({"RHEE", "RTOE", "SACR"});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->foot(Side::left).complete());
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_NE(found->notes[0].find("the left heel or ankle and the left toes"), std::string::npos);
}

TEST(GaitMarkers, WhatIsMissingIsNamedInOneSentence) {
  const auto found = find_gait_markers({"LHEE", "RTOE", "Head"});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::bad_input);
  EXPECT_NE(found.error().message.find("no marker of the left toes and the right heel or ankle"),
            std::string::npos)
      << found.error().message;
}

TEST(GaitMarkers, GivenNamesTakePrecedence) {
  const Names names{"RFT1", "RFT2", "LFT1", "LFT2", "LHEE", "PV1"};
  const std::vector<MarkerRole> roles{{"right_heel", "RFT1"},
                                      {"right_toe", "RFT2"},
                                      {"left_heel", "LFT1"},
                                      {"left_toe", "LFT2"},
                                      {"sacrum", "PV1"}};
  const auto found = find_gait_markers(names, roles);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->foot(Side::left).heel, 2);
  EXPECT_EQ(found->pelvis, (std::vector<std::vector<std::int64_t>>{{5}}));
}

TEST(GaitMarkers, WrongRolesAndNamesAreRefused) {
  const std::vector<MarkerRole> no_role{{"left_knee", "LHEE"}}, no_name{{"left_heel", "LHEEL"}};
  const auto role = find_gait_markers({"LHEE"}, no_role), name = find_gait_markers({"LHEE"}, no_name);
  ASSERT_FALSE(role || name);
  EXPECT_EQ(role.error().code, Code::usage);
  EXPECT_NE(role.error().message.find("left_ankle"), std::string::npos);
  EXPECT_EQ(name.error().code, Code::bad_input);
  EXPECT_NE(name.error().message.find("nearest: LHEE"), std::string::npos) << name.error().message;
}

}  // namespace
}  // namespace kinemark::analysis

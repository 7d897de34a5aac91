// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/landmarks.h"

#include <gtest/gtest.h>

#include <string>

namespace kinemark::motion {
namespace {

struct Named {
  const char* name;
  BodyPart part;
  Side side;
};

TEST(Landmarks, NamesOfManyLaboratoriesMeanTheSamePlace) {
  using enum BodyPart;
  for (const auto& [name, part, side] :
       {Named{"RASI", pelvis, Side::right}, Named{"R.ASIS", pelvis, Side::right},
        Named{"r asis", pelvis, Side::right}, Named{"R_IAS", pelvis, Side::right},
        Named{"ASIS_R", pelvis, Side::right}, Named{"Ann:LASI", pelvis, Side::left},
        Named{"LLFE", thigh, Side::left}, Named{"RLFC", thigh, Side::right},
        Named{"L.Knee.Med", thigh, Side::left}, Named{"LMKN", thigh, Side::left},
        Named{"LTIB", shank, Side::left}, Named{"LLMAL", shank, Side::left}, Named{"RLM", shank, Side::right},
        Named{"LMED", shank, Side::left}, Named{"RHEE", foot, Side::right}, Named{"RCAL", foot, Side::right},
        Named{"C7", trunk, Side::middle}, Named{"V.Sacral", pelvis, Side::middle},
        Named{"L.Wrist.Med", forearm, Side::left}}) {
    const auto landmark = landmark_of(name);
    ASSERT_TRUE(landmark) << name;
    EXPECT_EQ(landmark->part, part) << name;
    EXPECT_EQ(landmark->side, side) << name;
  }
}

TEST(Landmarks, WhatIsComputedOrUnknownIsNone) {
  for (const char* name :
       {"LFEO", "LFEL", "RTIA", "PELO", "LHipAngles", "*12", "", "L", "R", "WheelchairRearR", "Probe1"})
    EXPECT_FALSE(landmark_of(name)) << name;
}

TEST(Landmarks, MedialAndLateralLieOnBothSidesOfTheJoint) {
  EXPECT_GT(landmark_of("LKNE")->x_in_part.z(), 0.03);
  EXPECT_LT(landmark_of("LMKN")->x_in_part.z(), -0.03);
  EXPECT_GT(landmark_of("RLM")->x_in_part.z(), 0.03);
  EXPECT_LT(landmark_of("RMMAL")->x_in_part.z(), -0.03);
}

TEST(Landmarks, TheHeelLiesBehindTheToeAndTheFrontBeforeTheBack) {
  EXPECT_LT(landmark_of("LHEE")->x_in_part.x(), landmark_of("LTOE")->x_in_part.x() - 0.1);
  EXPECT_GT(landmark_of("LASI")->x_in_part.x(), landmark_of("LPSI")->x_in_part.x() + 0.1);
}

TEST(Landmarks, AWandsHeightIsFreeOnEachSide) {
  const auto wand = landmark_of("LTHI"), bone = landmark_of("LANK");
  EXPECT_GT(wand->spread.own.y(), 0.04);
  EXPECT_LT(bone->spread.own.y(), 0.015);
}

TEST(Landmarks, ToesFlexAndBonesOfTheFootDoNot) {
  const Eigen::Vector3d toe = landmark_of("LTOE")->spread.by_posture;
  EXPECT_GT(toe.y(), 0.01) << "toes bend up";
  EXPECT_LT(toe.z(), 0.5 * toe.y()) << "not sideways";
  EXPECT_EQ(landmark_of("LMT2")->spread.by_posture, Eigen::Vector3d::Zero());
  EXPECT_EQ(landmark_of("LHEE")->spread.by_posture, Eigen::Vector3d::Zero());
  EXPECT_EQ(landmark_of("LMT2")->x_in_part, landmark_of("LTOE")->x_in_part);
}

TEST(Landmarks, NamesOfAClusterThatTellASideAreKeptApart) {
  for (const auto* const part : {"Thigh", "Shank"}) {
    const auto name = [&](const char* side) { return std::string("L.") + part + "." + side; };
    const auto upper = landmark_of(name("Upper")), front = landmark_of(name("Front")),
               rear = landmark_of(name("Rear"));
    ASSERT_TRUE(upper && front && rear) << part;
    EXPECT_GT(front->x_in_part.x(), rear->x_in_part.x() + 0.05) << part;
    EXPECT_GT(upper->x_in_part.y(), front->x_in_part.y()) << part;
    EXPECT_GT(upper->x_in_part.y(), rear->x_in_part.y()) << part;
    EXPECT_LT(front->spread.own.x(), landmark_of("LTH1")->spread.own.x());
  }
}

TEST(Landmarks, SkinSlidesAboveThePelvis) {
  for (const auto* const name : {"C7", "LSHO", "LELB", "LWRA", "LFHD"})
    EXPECT_GT(landmark_of(name)->spread.by_posture.minCoeff(), 0.002) << name;
  EXPECT_EQ(landmark_of("LSHO")->part, BodyPart::shoulder);
  EXPECT_EQ(landmark_of("CLAV")->part, BodyPart::trunk);
}

TEST(Landmarks, NamesAreCutIntoSideAndRest) {
  EXPECT_EQ(split_marker_name("R.Thigh.Upper").stem, split_marker_name("L.Thigh.Upper").stem);
  EXPECT_EQ(split_marker_name("R.Thigh.Upper").side, Side::right);
  EXPECT_EQ(split_marker_name("L12").side, Side::left);
  EXPECT_EQ(split_marker_name("STRN").side, Side::middle);
}

}  // namespace
}  // namespace kinemark::motion

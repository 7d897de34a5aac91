// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_quantities.h"

#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using data::Quantity;
using data::Side;

GaitQuantity angle(std::string_view name) { return gait_quantity(name, Quantity::angle); }

TEST(GaitQuantities, KnowsPlugInGaitWhicheverWayItsComponentIsNamed) {
  for (const auto* name : {"LKneeAngles x", "LKneeAngles_flexion", "Ann:LKneeAngles x", "LKneeAnglesV x"}) {
    const auto knee = angle(name);
    EXPECT_EQ(knee.key, "knee_flexion") << name;
    EXPECT_EQ(knee.title, "Knee flexion") << name;
    EXPECT_EQ(knee.up, "flexion") << name;
    EXPECT_EQ(knee.down, "extension") << name;
    EXPECT_EQ(knee.side, Side::left) << name;
    EXPECT_TRUE(knee.same_sign) << name;
    EXPECT_EQ(knee.part, SheetPart::kinematics);
  }
  EXPECT_EQ(angle("RAnkleAngles_dorsiflexion").key, "ankle_dorsiflexion");
  EXPECT_EQ(angle("RFootProgressAngles z").key, "foot_progression");
  EXPECT_EQ(angle("LPelvisAngles_obliquity").key, "pelvis_obliquity");
}

TEST(GaitQuantities, EveryPlaceOfTheGridIsTakenOnce) {
  std::vector<std::pair<std::int64_t, std::int64_t>> positions;
  for (const auto* name : {"LPelvisAngles x", "LPelvisAngles y", "LPelvisAngles z", "LHipAngles x",
                           "LHipAngles y", "LHipAngles z", "LKneeAngles x", "LKneeAngles y", "LKneeAngles z",
                           "LAnkleAngles x", "subtalar_angle_l", "LFootProgressAngles z"}) {
    const auto what = angle(name);
    EXPECT_EQ(what.part, SheetPart::kinematics) << name;
    const std::pair place{what.row, what.column};
    EXPECT_EQ(std::ranges::find(positions, place), positions.end()) << name;
    positions.push_back(place);
  }
  EXPECT_EQ(positions.size(), 12u);
}

TEST(GaitQuantities, SaysNothingOfASignThatDependsOnTheModel) {
  for (const auto* name : {"pelvis_tilt", "pelvis_list", "pelvis_rotation", "knee_angle_r"}) {
    const auto what = angle(name);
    EXPECT_EQ(what.part, SheetPart::kinematics) << name;
    EXPECT_FALSE(what.same_sign) << name;
    EXPECT_TRUE(what.up.empty()) << name;
  }
  EXPECT_EQ(angle("hip_flexion_r").up, "flexion");
  EXPECT_EQ(angle("hip_flexion_r").side, Side::right);
  EXPECT_EQ(angle("ankle_angle_l").up, "dorsi");
  EXPECT_EQ(angle("knee_angle_r").key, "knee_flexion");
}

TEST(GaitQuantities, OthersKeepTheirNamesInWords) {
  const auto thorax = angle("LThoraxAngles y");
  EXPECT_EQ(thorax.key, "ThoraxAngles y");
  EXPECT_EQ(thorax.title, "Thorax angles y");
  EXPECT_EQ(thorax.part, SheetPart::others);
  EXPECT_EQ(thorax.row, -1);
  EXPECT_EQ(angle("lumbar_extension").title, "Lumbar extension");
  EXPECT_FALSE(angle("lumbar_extension").side);
  EXPECT_EQ(angle("").title, "");
}

TEST(GaitQuantities, MomentsAndPowersStandByJointAndPlane) {
  const auto hip = gait_quantity("RHipMoment y", Quantity::moment);
  EXPECT_EQ(hip.title, "Hip moment, frontal");
  EXPECT_EQ(hip.part, SheetPart::kinetics);
  EXPECT_EQ(hip.row, 0);
  EXPECT_EQ(hip.column, 1);
  EXPECT_TRUE(hip.up.empty());  // internal or external: the file does not say
  const auto ankle = gait_quantity("LAnklePower z", Quantity::power);
  EXPECT_EQ(ankle.title, "Ankle power");
  EXPECT_EQ(ankle.row, 3);
  EXPECT_EQ(ankle.column, 2);
  EXPECT_EQ(ankle.up, "generated");
  EXPECT_EQ(gait_quantity("LElbowMoment x", Quantity::moment).row, -1);
  EXPECT_EQ(gait_quantity("vertical_ground_reaction", Quantity::force).title, "Vertical ground reaction");
}

TEST(GaitQuantities, MomentsOfSegmentsStandWithTheirSigns) {
  const auto hip = gait_quantity("LHipMoment_abduction", Quantity::moment_per_mass);
  EXPECT_EQ(hip.title, "Hip moment, frontal");
  EXPECT_EQ(hip.row, 0);
  EXPECT_EQ(hip.column, 1);
  EXPECT_EQ(hip.up, "abduction");
  EXPECT_EQ(hip.down, "adduction");
  EXPECT_EQ(hip.side, Side::left);
  const auto ankle = gait_quantity("RAnkleMoment_plantarflexion", Quantity::moment_per_mass);
  EXPECT_EQ(ankle.row, 2);
  EXPECT_EQ(ankle.column, 0);
  EXPECT_EQ(ankle.down, "dorsi");
  const auto knee = gait_quantity("RKneeMoment_internal_rotation", Quantity::moment_per_mass);
  EXPECT_EQ(knee.column, 2);
  EXPECT_EQ(knee.up, "internal");
  EXPECT_EQ(knee.down, "external");
  EXPECT_EQ(gait_quantity("RKneePower", Quantity::power_per_mass).row, 3);
  EXPECT_EQ(gait_quantity("RKneeMoment_sideways", Quantity::moment_per_mass).row, -1);
}

TEST(GaitQuantities, TorquesOfCoordinatesPointWhereTheirAnglesDo) {
  const auto hip = gait_quantity("hip_flexion_r_moment", Quantity::moment);
  EXPECT_EQ(hip.title, "Hip flexion, moment");
  EXPECT_EQ(hip.side, Side::right);
  EXPECT_EQ(hip.up, "flexion");
  EXPECT_EQ(hip.row, 0);
  EXPECT_EQ(gait_quantity("ankle_angle_r_moment", Quantity::moment).row, 2);
  EXPECT_EQ(gait_quantity("hip_adduction_r_power", Quantity::power).row, 5);
  EXPECT_EQ(gait_quantity("lumbar_bending_moment", Quantity::moment).row, -1);
  EXPECT_TRUE(gait_quantity("knee_angle_l_moment", Quantity::moment).up.empty());
  EXPECT_EQ(gait_quantity("knee_angle_l_power", Quantity::power).up, "generated");
}

TEST(GaitQuantities, NamesWithoutTheirSide) {
  EXPECT_EQ(name_without_side("LKneeAngles x"), "KneeAngles x");
  EXPECT_EQ(name_without_side("knee_angle_r"), "knee_angle");
  EXPECT_EQ(name_without_side("knee_angle_r_moment"), "knee_angle_moment");
  EXPECT_EQ(name_without_side("pelvis_tilt"), "pelvis_tilt");
  EXPECT_EQ(name_without_side("Lumbar"), "Lumbar");  // no side: the second letter is small
}

}  // namespace
}  // namespace kinemark::pipeline

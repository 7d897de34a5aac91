// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::known_curve;
using testing::known_gait;
using testing::known_norm;
using ::testing::Not;

constexpr std::size_t kLeft = 0, kRight = 1;

GaitSheet laid_out(const std::vector<SheetInput>& curves, const GaitNorms& norms = {},
                   const analysis::Gait& gait = known_gait()) {
  return make_gait_sheet("walk.c3d", curves, gait, norms);
}

std::vector<std::string> titles(const GaitSheet& sheet) {
  std::vector<std::string> out;
  for (const auto& panel : sheet.panels) out.push_back(panel.what.title);
  return out;
}

TEST(GaitSheet, MeanSpreadAndOwnErrorInTheUnitOfTheDrawing) {
  const auto sheet = laid_out({known_curve("LKneeAngles x", Side::left, 3, 1.5)});
  ASSERT_EQ(sheet.panels.size(), 1u);
  EXPECT_EQ(sheet.panels[0].unit, "deg");
  const auto& knee = *sheet.panels[0].sides[kLeft];
  EXPECT_EQ(knee.values.cols(), 3);
  for (const int p : {0, 25, 60, 100}) {
    EXPECT_NEAR(knee.mean[p], testing::known_angle_deg(1, 3, p / 100.0), 1e-9);
    EXPECT_NEAR(knee.between[p], 2.0, 1e-9);  // cycles are 2 deg apart: SD of -2, 0, 2
    EXPECT_NEAR(knee.own[p], 1.5, 1e-9);
    EXPECT_EQ(knee.count[p], 3);
  }
  EXPECT_EQ(knee.not_measured, 0.0);
  EXPECT_FALSE(sheet.panels[0].sides[kRight]);
}

TEST(GaitSheet, SidesOfOneAngleShareAPanelInTheOrderOfTheGrid) {
  const auto sheet =
      laid_out({known_curve("RAnkleAngles x", Side::right), known_curve("LThoraxAngles x", Side::left),
                known_curve("RHipAngles x", Side::right), known_curve("LHipAngles x", Side::left),
                known_curve("pelvis_tilt", Side::left), known_curve("pelvis_tilt", Side::right)});
  EXPECT_THAT(titles(sheet),
              ElementsAre("Pelvic tilt", "Hip flexion", "Ankle dorsiflexion", "Thorax angles x"));
  EXPECT_TRUE(sheet.panels[0].sides[kLeft] && sheet.panels[0].sides[kRight]);
  EXPECT_EQ(sheet.panels[1].sides[kLeft]->id, "LHipAngles x");
  EXPECT_EQ(sheet.panels[1].sides[kRight]->id, "RHipAngles x");
}

TEST(GaitSheet, LeavesOutLengthsAndCurvesOfTheOtherSide) {
  auto length = known_curve("pelvis_tx", Side::left);
  length.curves.quantity = data::Quantity::length;
  const auto sheet = laid_out({length, known_curve("LKneeAngles x", Side::right)});
  EXPECT_TRUE(sheet.panels.empty());
}

TEST(GaitSheet, KineticsAreOfTheLegs) {
  auto lumbar = known_curve("lumbar_bending_moment", Side::left),
       hip = known_curve("hip_flexion_l_moment", Side::left);
  lumbar.curves.quantity = hip.curves.quantity = data::Quantity::moment;
  EXPECT_THAT(titles(laid_out({lumbar, hip})), ElementsAre("Hip flexion, moment"));
}

TEST(GaitSheet, FilesKeepTheirUnit) {
  auto moment = known_curve("LHipMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  moment.unit = "Nmm";
  const auto sheet = laid_out({moment});
  ASSERT_EQ(sheet.panels.size(), 1u);
  EXPECT_EQ(sheet.panels[0].unit, "Nmm");
  EXPECT_NEAR(sheet.panels[0].sides[kLeft]->mean[0], 20.0 * kRadPerDeg, 1e-12);  // as it came
}

TEST(GaitSheet, LeavingTheGround) {
  auto gait = known_gait();
  gait.cycles[1].off_s += 0.06;
  const auto sheet = laid_out({known_curve("LKneeAngles x", Side::left)}, {}, gait);
  EXPECT_EQ(sheet.feet[kLeft].cycles, 3);
  EXPECT_NEAR(sheet.feet[kLeft].off_share, 0.62, 1e-9);
  EXPECT_NEAR(sheet.feet[kLeft].off_s, 0.62, 1e-9);
  EXPECT_NEAR(sheet.feet[kLeft].off_sd_share, 0.06 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(sheet.feet[kRight].off_share, 0.64, 1e-9);
}

TEST(GaitSheet, WhereTheFootIsNotSeenToLeaveNothingIsSaid) {
  auto gait = known_gait(1, 0);
  gait.cycles[0].off_s = kNaN;
  const auto sheet = laid_out({known_curve("LKneeAngles x", Side::left, 1)}, {}, gait);
  EXPECT_TRUE(std::isnan(sheet.feet[kLeft].off_share));
  EXPECT_TRUE(std::isnan(sheet.feet[kLeft].off_s));
}

TEST(GaitSheet, OneCycleAndNoCycleAreReported) {
  const auto sheet = laid_out({known_curve("LKneeAngles x", Side::left, 1)}, {}, known_gait(1, 0));
  EXPECT_THAT(sheet.remarks, Contains("Left: one cycle alone has no deviation between cycles"));
  EXPECT_THAT(sheet.remarks, Contains("Right: there is no cycle from strike to strike"));
  EXPECT_TRUE(std::isnan(sheet.panels[0].sides[kLeft]->between[50]));
  const auto three = laid_out({known_curve("LKneeAngles x", Side::left)});
  EXPECT_THAT(three.remarks, Not(Contains(HasSubstr("one cycle alone has no deviation"))));
  EXPECT_THAT(three.remarks, Not(Contains(HasSubstr("there is no cycle from strike to strike"))));
}

TEST(GaitSheet, WhatIsNowhereMeasuredIsReportedAndTheRestDrawn) {
  const auto sheet = laid_out({testing::missing_curve("LKneeAngles x", Side::left),
                               known_curve("RKneeAngles x", Side::right),
                               testing::missing_curve("LHipAngles x", Side::left)});
  EXPECT_THAT(titles(sheet), ElementsAre("Knee flexion"));
  EXPECT_THAT(sheet.remarks, Contains(HasSubstr("Left: 2 curves without a value in 3 cycles: ")));
}

TEST(GaitSheet, CountsWhatIsMissing) {
  auto curve = known_curve("LKneeAngles x", Side::left, 2);
  for (std::size_t p = 0; p < 101; ++p) curve.curves.values[p] = kNaN;  // the first cycle
  curve.curves.values[101] = kNaN;                                      // and the strike of the second
  const auto sheet = laid_out({curve});
  const auto& knee = *sheet.panels[0].sides[kLeft];
  EXPECT_NEAR(knee.not_measured, 102.0 / 202.0, 1e-12);
  EXPECT_TRUE(std::isnan(knee.mean[0]));
  EXPECT_EQ(knee.count[1], 1);
  EXPECT_TRUE(std::isnan(knee.between[1]));
}

TEST(GaitSheet, NormsAreAtThePointsOfTheCurve) {
  const auto sheet =
      laid_out({known_curve("LKneeAngles x", Side::left)}, {.curves = {known_norm("KneeAngles x")}});
  const auto& knee = *sheet.panels[0].sides[kLeft];
  ASSERT_EQ(knee.norm.rows(), 101);
  EXPECT_DOUBLE_EQ(knee.norm(33, 0), 10.0);  // between two points of the norm
  EXPECT_DOUBLE_EQ(knee.norm(33, 1), 30.0);
  EXPECT_DOUBLE_EQ(knee.norm(33, 2), 20.0);
  EXPECT_EQ(knee.norm_source, "A book");
  EXPECT_THAT(sheet.remarks, Not(Contains(HasSubstr("no curve here; drawn are"))));
  EXPECT_THAT(sheet.remarks, Not(Contains(HasSubstr("': it is not drawn"))));
}

TEST(GaitSheet, NormsThatFitNothingOrAreInOtherUnitsAreReported) {
  auto radians = known_norm("HipAngles x");
  radians.unit = "rad";
  const auto sheet =
      laid_out({known_curve("LKneeAngles x", Side::left), known_curve("LHipAngles x", Side::left)},
               {.curves = {known_norm("shoulder_flexion"), radians}});
  EXPECT_THAT(sheet.remarks,
              Contains("the norm's shoulder_flexion fits no curve here; drawn are LHipAngles x, "
                       "LKneeAngles x"));
  EXPECT_THAT(sheet.remarks,
              Contains("the norm of HipAngles x is in 'rad', the curve in 'deg': it is not drawn"));
  EXPECT_EQ(sheet.panels[0].sides[kLeft]->norm.rows(), 0);
}

TEST(GaitSheet, CurvesWithoutAValueAreNotAmongThoseDrawn) {
  const GaitNorms norms{.curves = {known_norm("shoulder_flexion")}};
  const auto one = laid_out(
      {known_curve("LKneeAngles x", Side::left), testing::missing_curve("RKneeAngles x", Side::right),
       testing::missing_curve("LHipAngles x", Side::left)},
      norms);
  EXPECT_THAT(one.remarks,
              Contains("the norm's shoulder_flexion fits no curve here; drawn are LKneeAngles x"));
  const auto none = laid_out({testing::missing_curve("LKneeAngles x", Side::left)}, norms);
  EXPECT_THAT(none.remarks, Contains("the norm's shoulder_flexion fits no curve here; none is drawn"));
}

TEST(GaitSheet, APelvisThatCountsOneWayNeedsTheNormOfASide) {
  const std::vector<SheetInput> curves{known_curve("pelvis_list", Side::left),
                                       known_curve("pelvis_list", Side::right),
                                       known_curve("pelvis_tilt", Side::left)};
  auto of_left = known_norm("pelvis_list");
  const auto plain = laid_out(curves, {.curves = {of_left, known_norm("pelvis_tilt")}});
  EXPECT_EQ(plain.panels[0].sides[kLeft]->norm.rows(), 101);  // the tilt is the same from both sides
  EXPECT_FALSE(plain.panels[0].mirrored);
  EXPECT_TRUE(plain.panels[1].mirrored);
  EXPECT_EQ(plain.panels[1].sides[kLeft]->norm.rows(), 0);
  EXPECT_THAT(plain.remarks, Contains(HasSubstr("the norm of pelvis_list tells no side, but the curve counts "
                                                "one way for both: it is not drawn")));
  of_left.side = Side::left;
  const auto sided = laid_out(curves, {.curves = {of_left}});
  EXPECT_EQ(sided.panels[1].sides[kLeft]->norm.rows(), 101);
  EXPECT_EQ(sided.panels[1].sides[kRight]->norm.rows(), 0);
  EXPECT_THAT(sided.remarks, Not(Contains(HasSubstr("tells no side, but the curve"))));
  EXPECT_FALSE(laid_out({known_curve("LPelvisAngles y", Side::left)}).panels[0].mirrored);
}

TEST(GaitSheet, TheKneeTellsItsSignBySwinging) {
  const auto flexed = laid_out({known_curve("knee_angle_l", Side::left)});
  EXPECT_EQ(flexed.panels[0].what.up, "flexion");
  const auto turned = laid_out({known_curve("knee_angle_l", Side::left, 3, 0.0, -1.0)});
  EXPECT_EQ(turned.panels[0].what.up, "extension");
  EXPECT_EQ(turned.panels[0].what.down, "flexion");
  // A norm of flexion fits the one whose sign is the same.
  const GaitNorms norms{.curves = {known_norm("Knee flexion")}};
  EXPECT_EQ(laid_out({known_curve("knee_angle_l", Side::left)}, norms).panels[0].sides[kLeft]->norm.rows(),
            101);
  EXPECT_EQ(laid_out({known_curve("knee_angle_l", Side::left, 3, 0.0, -1.0)}, norms)
                .panels[0]
                .sides[kLeft]
                ->norm.rows(),
            0);
}

TEST(GaitSheet, AStiffKneeTellsNoSign) {
  auto stiff = known_curve("knee_angle_l", Side::left);
  for (auto& v : stiff.curves.values) v *= 0.3;
  EXPECT_TRUE(laid_out({stiff}).panels[0].what.up.empty());
}

TEST(GaitSheet, PanelsAreFoundByKeyTitleAndName) {
  const auto sheet =
      laid_out({known_curve("LKneeAngles x", Side::left), known_curve("hip_flexion_r", Side::right)});
  const auto* knee = find_panel(sheet, "knee_flexion");
  ASSERT_NE(knee, nullptr);
  EXPECT_EQ(find_panel(sheet, "Knee Flexion"), knee);
  EXPECT_EQ(find_panel(sheet, "LKneeAngles x"), knee);
  EXPECT_EQ(find_panel(sheet, "KneeAngles x"), knee);
  EXPECT_EQ(find_panel(sheet, "hip_flexion"), sheet.panels.data());
  EXPECT_EQ(find_panel(sheet, "ankle"), nullptr);
}

TEST(GaitSheet, NothingInNothingOut) {
  const auto sheet = make_gait_sheet("walk.c3d", {}, {}, {});
  EXPECT_TRUE(sheet.panels.empty());
  EXPECT_EQ(sheet.remarks.size(), 2u);  // neither foot has a cycle
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::known_curve;
using ::testing::Not;

GaitSheet figures_of(const std::vector<SheetInput>& curves, const GaitNorms& norms = {},
                     const analysis::Gait& gait = testing::known_gait()) {
  return make_gait_sheet("walk.c3d", curves, gait, norms);
}

std::vector<std::string> key_names(const report::Figure& figure) {
  std::vector<std::string> out;
  for (const auto& key : figure.keys) out.push_back(key.name);
  return out;
}

const report::FigurePanel& panel_of(const report::Figure& figure, const std::string& title) {
  return *std::ranges::find(figure.panels, title, &report::FigurePanel::title);
}

TEST(GaitFigures, TheGridThatCliniciansKnow) {
  const auto figures = gait_figures(figures_of(testing::known_walk()));
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].name, "gait_kinematics");
  const auto& figure = figures[0].figure;
  EXPECT_EQ(figure.columns, 3);
  ASSERT_EQ(figure.panels.size(), 12u);
  const char* titles[] = {"Pelvic tilt (deg)",
                          "Pelvic obliquity (deg)",
                          "Pelvic rotation (deg)",
                          "Hip flexion (deg)",
                          "Hip adduction (deg)",
                          "Hip rotation (deg)",
                          "Knee flexion (deg)",
                          "Knee varus (deg)",
                          "Knee rotation (deg)",
                          "Ankle dorsiflexion (deg)",
                          "",
                          "Foot progression (deg)"};
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(figure.panels[i].title, titles[i]);
  EXPECT_TRUE(figure.panels[10].blank);
  // The lowest of each column names the axis.
  EXPECT_EQ(figure.panels[9].x_label, "gait cycle (%)");
  EXPECT_EQ(figure.panels[7].x_label, "gait cycle (%)");
  EXPECT_EQ(figure.panels[11].x_label, "gait cycle (%)");
  EXPECT_TRUE(figure.panels[6].x_label.empty());
  EXPECT_EQ(figure.panels[6].y_up, "flexion");
  EXPECT_EQ(figure.panels[6].y_down, "extension");
}

TEST(GaitFigures, DrawsTheNumbersOfTheSheet) {
  const auto sheet = figures_of(
      {known_curve("LKneeAngles x", Side::left, 3, 2.0), known_curve("RKneeAngles x", Side::right)});
  const auto figure = gait_figures(sheet)[0].figure;
  const auto& panel = panel_of(figure, "Knee flexion (deg)");
  const auto& knee = *sheet.panels[0].sides[0];
  ASSERT_EQ(panel.bands.size(), 2u);
  EXPECT_EQ(panel.bands[0].colour, side_colour(Side::left));
  EXPECT_TRUE(panel.bands[0].low.isApprox(knee.mean - knee.between));
  EXPECT_TRUE(panel.bands[0].high.isApprox(knee.mean + knee.between));
  // Left: three cycles, two dotted lines, the mean; right: three cycles and the mean, without an own error.
  ASSERT_EQ(panel.lines.size(), 10u);
  for (int c = 0; c < 3; ++c)
    EXPECT_TRUE(panel.lines[static_cast<std::size_t>(c)].y.isApprox(knee.values.col(c)));
  EXPECT_TRUE(panel.lines[3].dotted);
  EXPECT_NEAR(panel.lines[4].y[10] - panel.lines[3].y[10], 2.0 * 1.959964 * 2.0, 1e-9);
  EXPECT_TRUE(panel.lines[5].y.isApprox(knee.mean));
  EXPECT_FALSE(panel.lines[5].dashed);
  EXPECT_TRUE(panel.lines[9].dashed);  // the right, for who sees no colour
  EXPECT_EQ(panel.lines[9].colour, side_colour(Side::right));
}

TEST(GaitFigures, MarksWhereEachFootLeavesTheGround) {
  const auto sheet =
      figures_of({known_curve("LKneeAngles x", Side::left), known_curve("RKneeAngles x", Side::right)});
  const auto figure = gait_figures(sheet)[0].figure;
  const auto& marks = panel_of(figure, "Knee flexion (deg)").marks;
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_NEAR(marks[0].x, 60.0, 1e-9);
  EXPECT_NEAR(marks[1].x, 64.0, 1e-9);
  EXPECT_EQ(marks[0].colour, side_colour(Side::left));
  EXPECT_TRUE(marks[1].dashed);
  EXPECT_THAT(figure.notes[0],
              HasSubstr("Left: 3 cycles, toe-off at 60.0 \u00b1 0.0 % (0.60 s); Right: 3 cycles"));
}

TEST(GaitFigures, ANormOfBothSidesIsDrawnOnceBehindAll) {
  const auto sheet =
      figures_of({known_curve("LKneeAngles x", Side::left), known_curve("RKneeAngles x", Side::right)},
                 {.curves = {testing::known_norm("KneeAngles x")}});
  const auto figure = gait_figures(sheet)[0].figure;
  const auto& bands = panel_of(figure, "Knee flexion (deg)").bands;
  ASSERT_EQ(bands.size(), 3u);
  EXPECT_EQ(bands[0].low[50], 10.0);
  EXPECT_NE(bands[1].colour, bands[0].colour);
  EXPECT_THAT(figure.notes, Contains(HasSubstr("Norm: A book (mean \u00b1 2 SD at each point)")));
  EXPECT_THAT(key_names(figure), Contains("norm"));
}

TEST(GaitFigures, NormsOfEachSideAreBothDrawn) {
  const auto sheet = figures_of(
      {known_curve("LKneeAngles x", Side::left), known_curve("RKneeAngles x", Side::right)},
      {.curves = {testing::known_norm("LKneeAngles x", 20.0), testing::known_norm("RKneeAngles x", 25.0)}});
  EXPECT_EQ(gait_figures(sheet)[0].figure.panels[0].bands.size(), 4u);
}

TEST(GaitFigures, OnlyWhatIsDrawnIsExplained) {
  const auto one =
      gait_figures(figures_of({known_curve("LKneeAngles x", Side::left, 1)}, {}, testing::known_gait(1, 0)));
  const auto names = key_names(one[0].figure);
  EXPECT_THAT(names, Contains("Left, mean of 1 cycle"));
  for (const char* word : {"Right", "SD", "error", "norm"})
    EXPECT_THAT(names, Not(Contains(HasSubstr(word))));
  EXPECT_EQ(one[0].figure.panels[0].lines.size(), 1u);  // one cycle is its own mean
  const auto all = gait_figures(figures_of(testing::known_walk(2.0)));
  EXPECT_THAT(key_names(all[0].figure), Contains(HasSubstr("own error")));
}

TEST(GaitFigures, TheShareNotMeasuredStandsAtThePanel) {
  auto curve = known_curve("LKneeAngles x", Side::left, 2);
  for (std::size_t p = 0; p < 101; ++p) curve.curves.values[p] = kNaN;
  const auto figure = gait_figures(figures_of({curve}))[0].figure;
  EXPECT_EQ(figure.panels[0].note, "left 50 % not measured");
}

TEST(GaitFigures, AnErrorThinnerThanALineIsReportedInWords) {
  const auto panel = [](double sd_deg) {
    return gait_figures(figures_of({known_curve("LKneeAngles x", Side::left, 3, sd_deg)}))[0]
        .figure.panels[0];
  };
  const auto dotted = [](const report::FigurePanel& of) {
    return std::ranges::count(of.lines, true, &report::FigureLine::dotted);
  };
  EXPECT_EQ(dotted(panel(2.0)), 2);
  EXPECT_TRUE(panel(2.0).note.empty());
  EXPECT_EQ(dotted(panel(0.05)), 0);
  EXPECT_EQ(panel(0.05).note, "own error \u00b1 0.098 deg at most");
  EXPECT_EQ(panel(0.001).note, "own error below 0.01 deg");
}

TEST(GaitFigures, UnitsOfAFileAreNotTrustedToTellTheMass) {
  auto moment = known_curve("LHipMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  moment.unit = "Nmm";
  EXPECT_THAT(gait_figures(figures_of({moment}))[0].figure.notes, Contains(HasSubstr("per kilogram")));
  moment.curves.id = "hip_flexion_l_moment";
  moment.unit.clear();
  EXPECT_THAT(gait_figures(figures_of({moment}))[0].figure.notes, Not(Contains(HasSubstr("per kilogram"))));
}

TEST(GaitFigures, KineticsAndOthersAreFiguresOfTheirOwn) {
  auto moment = known_curve("LHipMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  auto power = known_curve("LAnklePower z", Side::left);
  power.curves.quantity = data::Quantity::power;
  const auto figures = gait_figures(figures_of(
      {moment, power, known_curve("LThoraxAngles x", Side::left), known_curve("LHipAngles x", Side::left)}));
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_EQ(figures[1].name, "gait_other_angles");
  EXPECT_EQ(figures[2].name, "gait_kinetics");
  const auto& panels = figures[2].figure.panels;
  ASSERT_EQ(panels.size(), 6u);  // a row of moments, a row of powers
  EXPECT_EQ(panels[0].title, "Hip moment, sagittal (N m)");
  EXPECT_TRUE(panels[3].blank);
  EXPECT_EQ(panels[5].title, "Ankle power (W)");
  EXPECT_EQ(panels[5].y_up, "generated");
}

TEST(GaitFigures, AGroundReactionOfSomeCyclesSaysOfHowMany) {
  auto force = known_curve("vertical_ground_reaction", Side::left, 3);
  force.curves.quantity = data::Quantity::force;
  for (std::size_t p = 0; p < 202; ++p) force.curves.values[p] = kNaN;
  const auto figures = gait_figures(figures_of({force}));
  EXPECT_EQ(figures[0].figure.panels[0].note, "left 1 of 3 cycles");
  EXPECT_EQ(figures[0].figure.panels[0].title, "Vertical ground reaction (N)");
}

TEST(GaitFigures, SidesDifferInColourAndInStroke) {
  EXPECT_NE(side_colour(Side::left), side_colour(Side::right));
  EXPECT_EQ(sentence_of({.cycles = 1}, Side::right), "Right: 1 cycle");
  EXPECT_EQ(sentence_of({.cycles = 2, .off_share = 0.612, .off_s = 0.66, .off_sd_share = 0.008}, Side::left),
            "Left: 2 cycles, toe-off at 61.2 \u00b1 0.8 % (0.66 s)");
}

TEST(GaitFigures, NothingHasNoFigure) { EXPECT_TRUE(gait_figures(figures_of({})).empty()); }

}  // namespace
}  // namespace kinemark::pipeline

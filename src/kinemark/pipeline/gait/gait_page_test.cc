// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::HasSubstr;
using ::testing::Not;

std::string page_of(const GaitSheet& sheet, const GaitPageFacts& facts = {.angles_from = "Plug-in Gait"}) {
  return gait_page(sheet, gait_deviation(sheet), gait_figures(sheet), facts);
}

GaitSheet page_walk(const GaitNorms& norms = {}, double sd_deg = 0.5) {
  return make_gait_sheet("walk.c3d", testing::known_walk(sd_deg), testing::known_gait(), norms);
}

GaitNorms all_norms() {
  GaitNorms out;
  for (const auto& name : testing::grid_names()) out.curves.push_back(testing::known_norm(name));
  out.measures.push_back({.id = "stride_time", .unit = "s", .low = 1.1, .high = 1.3, .source = "B"});
  return out;
}

TEST(GaitPage, HoldsFiguresMeasuresEventsAndHowToReadThem) {
  const auto page = page_of(page_walk());
  EXPECT_THAT(page, ::testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("<h1>Gait report: walk.c3d</h1>"));
  EXPECT_THAT(page, HasSubstr("Left: 3 cycles, toe-off at 60.0"));
  EXPECT_THAT(page, HasSubstr("<figure id=\"gait_kinematics\">\n<svg"));
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"row\">Stride time</th><td>s</td><td class=\"number\">1 [0.99 to 1.01]"));
  EXPECT_THAT(page, HasSubstr("In brackets the 95 % interval."));
  EXPECT_THAT(page, HasSubstr("<td>Left</td><td>Foot Strike</td><td class=\"number\">0.000</td>"));
  EXPECT_THAT(page, HasSubstr("O'Connor 2007"));
  EXPECT_THAT(page, HasSubstr("Dotted lines hold 95 %"));
  EXPECT_THAT(page, HasSubstr("Angles: Plug-in Gait."));
}

TEST(GaitPage, WhereNoAngleIsDrawnItSaysSo) {
  auto moment = testing::known_curve("LHipMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  for (const auto& curves : {std::vector<SheetInput>{}, std::vector{moment}}) {
    const auto page = page_of(make_gait_sheet("walk.c3d", curves, testing::known_gait(), {}));
    EXPECT_THAT(page, HasSubstr("Angles: none."));
    EXPECT_THAT(page, Not(HasSubstr("Plug-in Gait")));
  }
}

TEST(GaitPage, NeedsNothingElseAndRunsNothing) {
  const auto page = page_of(page_walk());
  for (const char* word : {"<script", "src=", "href=", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST(GaitPage, SaysNothingOfWhatIsAbsent) {
  const auto page = page_of(page_walk({}, 0.0));
  EXPECT_THAT(page, Not(HasSubstr("Dotted lines")));
  EXPECT_THAT(page, HasSubstr("How exact the angles are is not known"));
  EXPECT_THAT(page, Not(HasSubstr("Norm")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"deviation\"")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"remarks\"")));
  EXPECT_THAT(page, Not(HasSubstr("treadmill")));
}

TEST(GaitPage, ComparesWithTheNormAndNamesItsSource) {
  const auto page = page_of(page_walk(all_norms()));
  EXPECT_THAT(page, HasSubstr("Norm: A book (mean \u00b1 2 SD at each point)"));
  EXPECT_THAT(page, HasSubstr("<span class=\"judged beyond\">below</span>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">1.1 to 1.3</td>"));
  EXPECT_THAT(page, HasSubstr("Norm: B."));
}

TEST(GaitPage, TheProfileScoreIsGivenWithItsDefinition) {
  const auto sheet = page_walk(all_norms());
  const auto page = page_of(sheet);
  EXPECT_THAT(page, HasSubstr("Baker et al. 2009"));
  EXPECT_THAT(page,
              HasSubstr("Gait Profile Score of both sides: 21.1 deg."));  // 30 deg sine: 30 sqrt(50 / 101)
  auto curves = testing::known_walk();
  std::erase_if(curves, [](const SheetInput& one) { return one.curves.id.ends_with("HipAngles z"); });
  const auto partial = page_of(make_gait_sheet("walk.c3d", curves, testing::known_gait(), all_norms()));
  EXPECT_THAT(partial, HasSubstr("No Gait Profile Score of both sides"));
  EXPECT_THAT(partial, HasSubstr("are Hip rotation."));
}

TEST(GaitPage, RemarksOfJobAndSheetOnceEach) {
  auto sheet = make_gait_sheet("walk", {testing::known_curve("LKneeAngles x", Side::left, 1)},
                               testing::known_gait(1, 0), {});
  const auto page = page_of(sheet, {.angles_from = "x", .warnings = {sheet.remarks[0], "a < b"}});
  EXPECT_THAT(page, HasSubstr("<li>a &lt; b</li>"));
  const auto first = page.find("one cycle alone has no deviation");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(page.find("one cycle alone has no deviation", first + 1), std::string::npos);
}

TEST(GaitPage, NamesAreEscaped) {
  const auto sheet =
      make_gait_sheet("<b>&", {testing::known_curve("L<i>Angles x", Side::left)}, testing::known_gait(), {});
  const auto page = page_of(sheet, {.angles_from = "<u>", .command_line = "kinemark <x>"});
  for (const char* word : {"<b>", "<i>", "<u>", "<x>"}) EXPECT_THAT(page, Not(HasSubstr(word)));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;"));
}

TEST(GaitPage, ATreadmillIsSaid) {
  auto gait = testing::known_gait();
  gait.treadmill = true;
  EXPECT_THAT(page_of(make_gait_sheet("w", testing::known_walk(), gait, {})), HasSubstr("On a treadmill"));
}

TEST(GaitPage, TheSameGivesTheSameBytes) {
  EXPECT_EQ(page_of(page_walk(all_norms())), page_of(page_walk(all_norms())));
}

}  // namespace
}  // namespace kinemark::pipeline

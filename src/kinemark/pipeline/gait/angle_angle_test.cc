// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/angle_angle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using report::SymbolShape;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::known_curve;
using ::testing::Not;

GaitSheet pairs_walk() { return make_gait_sheet("walk", testing::known_walk(), testing::known_gait(), {}); }

TEST(AngleAngle, HipAndKneeThenKneeAndAnkleUnlessAsked) {
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const auto pairs = angle_pairs(sheet, {}, remarks);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].x->what.key, "hip_flexion");
  EXPECT_EQ(pairs[0].y->what.key, "knee_flexion");
  EXPECT_EQ(pairs[1].y->what.key, "ankle_dorsiflexion");
  EXPECT_TRUE(remarks.empty());
}

TEST(AngleAngle, AnyTwoByKeyTitleOrName) {
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const std::vector<std::string> asked{"KneeAngles y:Pelvic tilt"};
  const auto pairs = angle_pairs(sheet, asked, remarks);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].x->what.key, "knee_varus");
  EXPECT_EQ(pairs[0].y->what.key, "pelvis_tilt");
  EXPECT_THAT(remarks, Not(Contains(HasSubstr(": there is no curve '"))));
}

TEST(AngleAngle, AnUnknownOneIsReportedWithTheNearestAndTheRestDrawn) {
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const std::vector<std::string> asked{"hip_flexion:knee_flexon", "hip_flexion:ankle_dorsiflexion"};
  EXPECT_EQ(angle_pairs(sheet, asked, remarks).size(), 1u);
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("there is no curve 'knee_flexon' (nearest: knee_flexion")));
}

TEST(AngleAngle, MeanAndCovarianceAreThoseOfTheCyclesThatHaveBoth) {
  Random random(5, 1);
  SheetCurve x{.values = Eigen::MatrixXd(2, 4)}, y{.values = Eigen::MatrixXd(2, 4)};
  for (Eigen::Index i = 0; i < 2; ++i)
    for (Eigen::Index c = 0; c < 4; ++c)
      x.values(i, c) = random.gaussian(), y.values(i, c) = random.gaussian();
  y.values(0, 2) = kNaN;
  const auto points = cyclogram(x, y);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].cycles, 3);
  EXPECT_EQ(points[1].cycles, 4);
  const auto xs = x.values.row(1).transpose(), ys = y.values.row(1).transpose();
  const double mx = xs.mean(), my = ys.mean();
  EXPECT_NEAR(points[1].mean.x(), mx, 1e-12);
  EXPECT_NEAR(points[1].covariance(0, 1), ((xs.array() - mx) * (ys.array() - my)).sum() / 3.0, 1e-12);
  EXPECT_NEAR(points[1].covariance(1, 1), (ys.array() - my).square().sum() / 3.0, 1e-12);
  EXPECT_NEAR(points[0].mean.x(), (x.values(0, 0) + x.values(0, 1) + x.values(0, 3)) / 3.0, 1e-12);
}

TEST(AngleAngle, OneCycleHasAMeanAndNoSpreadNoneHasNeither) {
  SheetCurve x{.values = Eigen::MatrixXd::Constant(2, 1, 3.0)}, y = x;
  EXPECT_TRUE(std::isnan(cyclogram(x, y)[0].covariance(0, 0)));
  EXPECT_EQ(cyclogram(x, y)[0].mean.x(), 3.0);
  x.values.setConstant(kNaN);
  EXPECT_TRUE(std::isnan(cyclogram(x, y)[0].mean.x()));
}

TEST(AngleAngle, HullOfASquareWithPointsInside) {
  const auto hull = convex_hull({{0, 0}, {1, 1}, {0.5, 0.5}, {1, 0}, {0, 1}, {0.5, 0.0}, {0.2, 0.9}});
  ASSERT_EQ(hull.size(), 4u);
  double doubled = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = hull[i], &b = hull[(i + 1) % 4];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_NEAR(doubled, 2.0, 1e-12);  // counter-clockwise, of area 1
  EXPECT_EQ(convex_hull({{1, 2}, {3, 4}}).size(), 2u);
}

TEST(AngleAngle, TheAreaReachesOneDeviationFromTheMeanAndNoFarther) {
  // Hip and knee both vary by 2 deg, together: the ellipse is a stroke along the diagonal.
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const auto pairs = angle_pairs(sheet, {}, remarks);
  const auto points = cyclogram(*pairs[0].x->sides[0], *pairs[0].y->sides[0]);
  const auto figures = angle_angle_figures(sheet, pairs);
  const auto& areas = figures[0].figure.panels[0].areas;
  ASSERT_EQ(areas.size(), 100u);
  for (std::size_t p = 0; p < 100; ++p) {
    double farthest = 0.0;
    for (Eigen::Index i = 0; i < areas[p].x.size(); ++i) {
      const Eigen::Vector2d corner(areas[p].x[i], areas[p].y[i]);
      farthest = std::max(farthest,
                          std::min((corner - points[p].mean).norm(), (corner - points[p + 1].mean).norm()));
    }
    EXPECT_NEAR(farthest, 2.0 * std::numbers::sqrt2, 0.02) << p;
  }
  EXPECT_EQ(areas[0].name, "1 SD between cycles");
  EXPECT_TRUE(areas[1].name.empty());
}

TEST(AngleAngle, SidesBesideEachOtherOnTheSameAxes) {
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const auto figures = angle_angle_figures(sheet, angle_pairs(sheet, {}, remarks));
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].name, "gait_hip_flexion_knee_flexion");
  EXPECT_EQ(figures[0].figure.title, "walk: Knee flexion against Hip flexion");
  const auto& panels = figures[0].figure.panels;
  ASSERT_EQ(panels.size(), 2u);
  EXPECT_EQ(panels[0].title, "Left");
  EXPECT_TRUE(panels[0].equal);
  EXPECT_EQ(panels[0].x_label, "Hip flexion (deg, flexion +)");
  EXPECT_FALSE(panels[0].room.empty());
  EXPECT_EQ(panels[0].lines.size(), 4u);  // three cycles and their mean
  EXPECT_EQ(panels[0].lines.back().width, 2.0);
}

TEST(AngleAngle, EventsAndTheDirectionOfTime) {
  const auto sheet = pairs_walk();
  std::vector<std::string> remarks;
  const auto figures = angle_angle_figures(sheet, angle_pairs(sheet, {}, remarks));
  const auto& symbols = figures[0].figure.panels[0].symbols;
  const auto arrow = std::ranges::find(symbols, SymbolShape::arrow, &report::FigureSymbol::shape);
  ASSERT_NE(arrow, symbols.end());
  EXPECT_GT(arrow->towards.x(), 0.0);  // at 12 % of a sine that rises until 25 %
  const auto strike = std::ranges::find(symbols, "strike", &report::FigureSymbol::name);
  ASSERT_NE(strike, symbols.end());
  EXPECT_NEAR(strike->at.x(), 20.0, 1e-9);
  const auto off = std::ranges::find(symbols, "toe-off", &report::FigureSymbol::name);
  ASSERT_NE(off, symbols.end());
  EXPECT_NEAR(off->at.y(), testing::known_angle_deg(1, 3, 0.6), 1e-9);
  EXPECT_EQ(off->shape, SymbolShape::ring);
}

TEST(AngleAngle, OneSideAloneStandsAlone) {
  const auto sheet = make_gait_sheet(
      "walk", {known_curve("RHipAngles x", Side::right, 1), known_curve("RKneeAngles x", Side::right, 1)},
      testing::known_gait(0, 1), {});
  std::vector<std::string> remarks;
  const auto figures = angle_angle_figures(sheet, angle_pairs(sheet, {}, remarks));
  ASSERT_EQ(figures.size(), 1u);
  const auto& panels = figures[0].figure.panels;
  EXPECT_EQ(panels[0].title, "Right");
  EXPECT_TRUE(panels[0].areas.empty());
  EXPECT_TRUE(panels[1].blank);
}

TEST(AngleAngle, DifferentUnitsHaveAxesOfTheirOwn) {
  auto moment = known_curve("LKneeMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  const auto sheet =
      make_gait_sheet("walk", {known_curve("LKneeAngles x", Side::left), moment}, testing::known_gait(), {});
  std::vector<std::string> remarks;
  const std::vector<std::string> asked{"knee_flexion:Knee moment, sagittal"};
  const auto figures = angle_angle_figures(sheet, angle_pairs(sheet, asked, remarks));
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_FALSE(figures[0].figure.panels[0].equal);
  EXPECT_EQ(figures[0].figure.panels[0].y_label, "Knee moment, sagittal (N m)");
}

}  // namespace
}  // namespace kinemark::pipeline

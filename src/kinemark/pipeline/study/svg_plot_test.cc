// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinemark/core/check.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(SvgPlot, DrawsLinesLegendAndTicks) {
  SvgPlot plot("Speed", "s", "m/s");
  plot.line("ours", "#112233", Eigen::VectorXd::LinSpaced(11, 0.0, 1.0),
            Eigen::VectorXd::LinSpaced(11, 0.0, 3.0));
  const auto svg = plot.svg();
  EXPECT_THAT(svg, HasSubstr("<title>Speed</title>"));
  EXPECT_THAT(svg, HasSubstr(">ours</text>"));
  EXPECT_THAT(svg, HasSubstr(">0.2</text>"));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#112233\""));
  EXPECT_EQ(count(svg, "L"), 10U);
}

TEST(SvgPlot, BreaksLinesWhereNothingWasSeen) {
  SvgPlot plot("", "", "");
  Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);
  y[3] = std::nan("");
  plot.line("", "red", Eigen::VectorXd::LinSpaced(6, 0.0, 1.0), y);
  EXPECT_EQ(count(plot.svg(), "L"), 3U);
  EXPECT_THAT(plot.svg(), Not(HasSubstr("nan")));
}

TEST(SvgPlot, EmptyPlotsAndSinglePointsAreFrames) {
  EXPECT_THAT(SvgPlot("", "", "").svg(), Not(HasSubstr("nan")));
  SvgPlot one("", "", "", true);
  one.line("", "red", Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Constant(1, 3.0));
  EXPECT_THAT(one.svg(), Not(HasSubstr("nan")));
  EXPECT_THROW(one.line("", "red", Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(3)), ContractError);
}

TEST(SvgPlot, LogarithmicAxesLeaveOutWhatIsNotPositive) {
  SvgPlot plot("", "", "mm");
  plot.logarithmic_y();
  Eigen::VectorXd x(4), y(4);
  x << 0, 1, 2, 3;
  y << 0.0, 1.0, 10.0, 100.0;
  plot.line("ours", "blue", x, y, 1.2, true);
  plot.dots("red", x, y);
  const auto svg = plot.svg();
  EXPECT_EQ(count(svg, "<circle"), 3U);
  EXPECT_EQ(count(svg, "L"), 2U);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2U);  // the line and its name
  for (const char* tick : {">1<", ">2<", ">5<", ">10<", ">50<", ">100<"}) EXPECT_THAT(svg, HasSubstr(tick));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_THROW(plot.dots("red", x, x.head(2)), ContractError);
}

TEST(SvgPlot, ManyNamesTakeSeveralLines) {
  SvgPlot few("", "", ""), many("", "", "");
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(2, 0.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    if (i < 2) few.line("a name", "red", x, x);
    many.line("quite a long name of a line", "red", x, x);
  }
  EXPECT_EQ(count(few.svg(), "y=\"22.0\""), 2U);
  EXPECT_LT(count(many.svg(), "y=\"22.0\""), 4U);
  EXPECT_GT(count(many.svg(), "y=\"36.0\""), 0U);
}

TEST(SvgPlot, BoxesAreDashedRectangles) {
  SvgPlot plot("", "", "", true);
  plot.box({-1.0, -1.0}, {1.0, 1.0});
  EXPECT_EQ(count(plot.svg(), "<rect"), 1U);
}

}  // namespace
}  // namespace kinemark::pipeline

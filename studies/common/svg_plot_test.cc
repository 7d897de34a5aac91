// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "kinemark/core/check.h"

namespace kinemark::studies {
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

TEST(SvgPlot, WordsMeanThemselves) {
  SvgPlot plot("a & b", "x < 1", "\"y\"");
  plot.line("p > q", "red", Eigen::VectorXd::LinSpaced(2, 0.0, 1.0), Eigen::VectorXd::LinSpaced(2, 0.0, 1.0));
  const auto svg = plot.svg();
  for (const char* label :
       {"<title>a &amp; b</title>", ">x &lt; 1</text>", ">&quot;y&quot;</text>", ">p &gt; q</text>"})
    EXPECT_THAT(svg, HasSubstr(label));
}

TEST(SvgPlot, EverythingDrawnLiesWithinTheFrame) {
  SvgPlot plot("", "", "");
  plot.line("up", "red", Eigen::VectorXd::LinSpaced(50, -3.0, 4.0),
            Eigen::VectorXd::LinSpaced(50, 1e-9, -1e6));
  plot.dots("blue", Eigen::VectorXd::Constant(1, 9.0), Eigen::VectorXd::Constant(1, 5e5));
  const auto svg = plot.svg();
  // Numbers of the line's path and of the dot, in pixels of a picture of 640 x 400.
  const auto path = svg.find("stroke=\"red\" stroke-width=\"1.2\"");
  ASSERT_NE(path, std::string::npos);
  const auto from = svg.find("d=\"M", path) + 4;
  std::string numbers = svg.substr(from, svg.find('"', from) - from);
  for (char& c : numbers)
    if (c == 'L') c = ' ';
  std::istringstream in(numbers);
  int points = 0;
  for (double x = 0.0, y = 0.0; in >> x >> y; ++points) {
    EXPECT_GE(x, 64.0);
    EXPECT_LE(x, 624.0);
    EXPECT_GE(y, 0.0);
    EXPECT_LE(y, 354.0);
  }
  EXPECT_EQ(points, 50);
}

TEST(SvgPlot, ScalesOfAllSizesHaveAFewRoundTicks) {
  for (const double scale : {1e-12, 1e-3, 1.0, 7e4, 1e15}) {
    SvgPlot plot("", "", "");
    plot.line("", "red", Eigen::VectorXd::LinSpaced(3, 0.0, 1.0), Eigen::VectorXd::LinSpaced(3, 0.0, scale));
    const auto ticks = count(plot.svg(), "text-anchor=\"end\"");
    EXPECT_GE(ticks, 3U) << scale;
    EXPECT_LE(ticks, 8U) << scale;
  }
}

}  // namespace
}  // namespace kinemark::studies

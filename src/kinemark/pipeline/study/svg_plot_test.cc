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

TEST(SvgPlot, BoxesAreDashedRectangles) {
  SvgPlot plot("", "", "", true);
  plot.box({-1.0, -1.0}, {1.0, 1.0});
  EXPECT_EQ(count(plot.svg(), "<rect"), 1U);
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Figure speed() {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(101, 0.0, 1.0);
  Eigen::VectorXd v = (t.array() * 3.0).sin();
  v[50] = std::nan("");
  const Eigen::VectorXd low = v.array() - 0.1, high = v.array() + 0.1;
  FigurePanel panel{.x_label = "time (s)", .y_label = "speed (m/s)"};
  panel.bands.push_back({.name = "1 SD", .colour = "#0072b2", .x = t, .low = low, .high = high});
  panel.lines.push_back({.name = "speed", .colour = "#0072b2", .x = t, .y = v});
  panel.marks.push_back({.name = "onset", .x = 0.25});
  panel.marks.push_back({.name = "beyond", .x = 7.0});
  return {.title = "a < b", .caption = "as measured", .panels = {panel}};
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Figure, SvgHoldsLettersAsLettersAndBreaksAtWhatIsMissing) {
  const auto svg = figure_svg(speed());
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 "));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  for (const char* words :
       {">a &lt; b</text>", ">speed (m/s)</text>", ">onset</text>", ">1 SD</text>", ">as measured</text>"})
    EXPECT_THAT(svg, HasSubstr(words));
  EXPECT_THAT(svg, Not(HasSubstr("beyond")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(times(svg, "stroke=\"#0072b2\" stroke-width=\"1.4\""),
            2u);                                                       // before and after the missing sample
  EXPECT_EQ(times(svg, "fill=\"#0072b2\" fill-opacity=\"0.2\""), 3u);  // and the legend's
}

TEST(Figure, EqualUnitsAreEquallyLong) {
  FigurePanel panel{.equal = true};
  panel.lines.push_back(
      {.colour = "#000000", .x = Eigen::Vector2d(0.0, 4.0), .y = Eigen::Vector2d(0.0, 1.0), .width = 3.5});
  const auto svg = figure_svg({.panels = {panel}});
  const auto at = svg.find("stroke-width=\"3.5\" d=\"M");
  ASSERT_NE(at, std::string::npos);
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + at + 22, "M%lf %lfL%lf %lf", &x0, &y0, &x1, &y1), 4);
  EXPECT_NEAR((x1 - x0) / (y0 - y1), 4.0, 0.01);
}

TEST(Figure, AnEmptyFigureIsAFrame) {
  EXPECT_THAT(figure_svg({.title = "nothing", .panels = {{}}}), HasSubstr("nothing"));
}

TEST(Figure, PngIsAPictureOrSaysWhyThereIsNone) {
  const auto png = figure_png(speed());
  if (!png) {
    EXPECT_EQ(png.error().code, Code::not_supported);
    return;
  }
  EXPECT_THAT(*png, ::testing::StartsWith("\x89PNG\r\n"));
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>((*png)[at + i]);
    return value;
  };
  EXPECT_EQ(number(16), 1920u);
  EXPECT_GT(number(20), 600u);
  EXPECT_EQ(make_png_canvas(1e6, 10.0, 1.0).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::report

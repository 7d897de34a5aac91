// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/timing_diagram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;

TimingDiagram diagram() {
  TimingDiagram out{.time_label = "time, ms", .end = 10.0, .traces = {}, .spans = {{0.0, 2.0, "short"}}};
  out.traces.push_back(
      {.name = "LED", .time = Eigen::Vector4d(0, 5, 5, 10), .level = Eigen::Vector4d(0, 0, 1, 1)});
  return out;
}

std::string svg_of(const TimingDiagram& d) {
  const auto canvas = make_svg_canvas(640.0, 300.0, "");
  draw(d, *canvas, {.left = 0.0, .right = 640.0, .top = 0.0, .bottom = height_of(d)});
  return canvas->finish().value();
}

TEST(TimingDiagram, TimeRunsFromTheNamesToTheRight) {
  const auto svg = svg_of(diagram());
  EXPECT_THAT(svg, HasSubstr(">LED<"));
  EXPECT_THAT(svg, HasSubstr(">time, ms<"));
  // 0 and 10 ms lie at 136 and 626 pixels; low at 34, high 24 above.
  EXPECT_THAT(svg, HasSubstr("d=\"M136.00 34.00L381.00 34.00L381.00 10.00L626.00 10.00\""));
}

TEST(TimingDiagram, SpansThatTouchGoBelowEachOther) {
  auto one = diagram(), apart = diagram(), touching = diagram();
  apart.spans.push_back({6.0, 9.0, "far"});
  touching.spans.push_back({1.0, 9.0, "across"});
  EXPECT_EQ(height_of(one), height_of(apart));
  EXPECT_GT(height_of(touching), height_of(one));
  EXPECT_THAT(svg_of(touching), HasSubstr(">across<"));
}

}  // namespace
}  // namespace kinemark::report

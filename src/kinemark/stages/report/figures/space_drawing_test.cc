// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/space_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Eigen::Matrix3Xd bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Matrix3Xd out(3, 2);
  out << from, to;
  return out;
}

std::string svg_of(const SpaceDrawing& scene) {
  const auto canvas = make_svg_canvas(640.0, 480.0, "");
  scene.draw(*canvas, {.left = 0.0, .right = 640.0, .top = 0.0, .bottom = 480.0});
  return canvas->finish().value();
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(SpaceDrawing, SeenFromTheFrontXComesTowardsTheViewer) {
  SpaceDrawing scene(0.0, 0.0);
  scene.line(bar({0, 0, 0}, {0, 1, 0}), {.width = 3.0});  // to the right
  scene.line(bar({0, 0, 0}, {5, 0, 1}), {.width = 3.0});  // upwards
  const auto svg = svg_of(scene);
  // One unit fills the height less its margins: 432 pixels.
  EXPECT_THAT(svg, HasSubstr("d=\"M104.00 456.00L536.00 456.00\""));
  EXPECT_THAT(svg, HasSubstr("d=\"M104.00 456.00L104.00 24.00\""));
}

TEST(SpaceDrawing, ShadowsLieOnTheFloorBelowEverything) {
  SpaceDrawing scene(30.0, 90.0);  // from above: a line covers its shadow
  scene.floor(-1.0);
  scene.line(bar({0, 0, 0}, {1, 0, 2}), {.colour = "#123456", .width = 3.0, .shadow = true});
  const auto svg = svg_of(scene);
  const auto grid = svg.find("#e2e2e2"), shadow = svg.find("#b8b8b8"), line = svg.find("#123456");
  ASSERT_NE(line, std::string::npos);
  EXPECT_LT(grid, shadow);
  EXPECT_LT(shadow, line);
  const auto path = [&](std::size_t at) {
    const auto d = svg.find(" d=\"", at);
    return svg.substr(d, svg.find('"', d + 4) - d);
  };
  EXPECT_EQ(path(shadow), path(line));
}

TEST(SpaceDrawing, DotsAndWords) {
  SpaceDrawing scene(0.0, 0.0);
  scene.dot("#cc0000", {0, 0, 0}, 4.0);
  scene.dot("#00cc00", {0, 1, 1}, 4.0, true);
  scene.label("x < y", {0, 0, 0}, Anchor::end);
  const auto svg = svg_of(scene);
  EXPECT_EQ(count(svg, "fill=\"#cc0000\""), 1U);
  EXPECT_LT(svg.find("r=\"4\" fill=\"#00cc00\""), svg.find("r=\"2.4\" fill=\"#ffffff\"")) << "a ring";
  EXPECT_THAT(svg, HasSubstr("text-anchor=\"end\""));
  EXPECT_THAT(svg, HasSubstr(">x &lt; y</text>"));
}

TEST(SpaceDrawing, ABoxHasTwelveEdgesAndAxesTheirNames) {
  SpaceDrawing scene(35.0, 20.0);
  scene.box({0, 0, 0}, {1, 2, 3});
  EXPECT_EQ(count(svg_of(scene), "stroke=\"#8a8a8a\""), 12U);
  scene.axes({0, 0, 0}, 0.1, {"x", "y", "z"});
  const auto svg = svg_of(scene);
  EXPECT_EQ(count(svg, "stroke-width=\"2.2\""), 3U);
  for (const char* name : {">x<", ">y<", ">z<"}) EXPECT_THAT(svg, HasSubstr(name));
}

TEST(SpaceDrawing, LinesAreDashedWhereTheySaySo) {
  SpaceDrawing scene(0.0, 0.0);
  scene.line(bar({0, 0, 0}, {0, 1, 0}), {});
  EXPECT_THAT(svg_of(scene), Not(HasSubstr("dasharray")));
  scene.line(bar({0, 0, 0}, {0, 1, 1}), {.dashed = true});
  EXPECT_THAT(svg_of(scene), HasSubstr("dasharray"));
}

TEST(SpaceDrawing, SquaresOfTheFloorAreRoundAndLieUnderEverything) {
  for (const double size : {0.003, 0.31, 1.0, 47.0}) {
    SpaceDrawing scene(0.0, 90.0);
    EXPECT_EQ(scene.square(), 0.0);
    scene.line(bar({0, 0, 0}, {size, size, size}), {});
    EXPECT_EQ(scene.square(), 0.0);  // no floor yet
    scene.floor(0.0);
    const double square = scene.square(),
                 first = square / std::pow(10.0, std::floor(std::log10(square) + 1e-9));
    EXPECT_TRUE(std::abs(first - 1.0) < 1e-6 || std::abs(first - 2.0) < 1e-6 || std::abs(first - 5.0) < 1e-6)
        << square;
    EXPECT_GE(8.0 * square, size);
    EXPECT_LE(square, size);
  }
}

TEST(SpaceDrawing, NothingFiniteIsAnEmptyPicture) {
  SpaceDrawing scene(0.0, 0.0);
  scene.floor(0.0);
  scene.dot("#cc0000", Eigen::Vector3d::Constant(std::nan("")), 4.0);
  EXPECT_THAT(svg_of(scene), Not(HasSubstr("nan")));
  EXPECT_THAT(svg_of(scene), Not(HasSubstr("inf")));
  EXPECT_THROW(scene.line(Eigen::Matrix3Xd::Zero(3, 1), {}), ContractError);
  EXPECT_THROW(SpaceDrawing(0.0, 91.0), ContractError);
}

}  // namespace
}  // namespace kinemark::report

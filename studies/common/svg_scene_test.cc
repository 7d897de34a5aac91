// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/svg_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Eigen::Matrix3Xd bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Matrix3Xd out(3, 2);
  out << from, to;
  return out;
}

TEST(SvgScene, SeenFromTheFrontXComesTowardsTheViewer) {
  SvgScene scene("Arm", 0.0, 0.0);
  scene.line("black", bar({0, 0, 0}, {0, 1, 0}), 3.0);  // to the right
  scene.line("blue", bar({0, 0, 0}, {5, 0, 1}), 3.0);   // upwards
  const auto svg = scene.svg();
  EXPECT_THAT(svg, HasSubstr("<title>Arm</title>"));
  // One unit fills the height less its margins: 432 pixels.
  EXPECT_THAT(svg, HasSubstr("d=\"M104.0 456.0L536.0 456.0\""));
  EXPECT_THAT(svg, HasSubstr("d=\"M104.0 456.0L104.0 24.0\""));
}

TEST(SvgScene, ShadowsLieOnTheFloorBelowEverything) {
  SvgScene scene("", 30.0, 90.0);  // from above: a line covers its shadow
  scene.floor(-1.0);
  scene.line("black", bar({0, 0, 0}, {1, 0, 2}), 3.0, true);
  const auto svg = scene.svg();
  const auto grid = svg.find("#e2e2e2"), shadow = svg.find("#b8b8b8"), line = svg.find("\"black\"");
  ASSERT_NE(line, std::string::npos);
  EXPECT_LT(grid, shadow);
  EXPECT_LT(shadow, line);
  const auto path = [&](std::size_t at) {
    const auto d = svg.find("d=\"", at);
    return svg.substr(d, svg.find('"', d + 3) - d);
  };
  EXPECT_EQ(path(shadow), path(line));
}

TEST(SvgScene, DotsAndWords) {
  SvgScene scene("", 0.0, 0.0);
  scene.dot("#cc0000", {0, 0, 0}, 4.0);
  scene.dot("#00cc00", {0, 1, 1}, 4.0, true);
  scene.label("elbow", {0, 0, 0});
  const auto svg = scene.svg();
  EXPECT_THAT(svg, HasSubstr("fill=\"#cc0000\" stroke=\"#fff\""));
  EXPECT_THAT(svg, HasSubstr("fill=\"#fff\" stroke=\"#00cc00\""));
  EXPECT_THAT(svg, HasSubstr(">elbow</text>"));
}

TEST(SvgScene, SquaresOfTheFloorAreRoundAndLieUnderEverything) {
  for (const double size : {0.003, 0.31, 1.0, 47.0}) {
    SvgScene scene("", 0.0, 90.0);
    EXPECT_EQ(scene.square(), 0.0);
    scene.line("black", bar({0, 0, 0}, {size, size, size}), 3.0);
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

TEST(SvgScene, WordsMeanThemselves) {
  SvgScene scene("a & b", 0.0, 0.0);
  scene.label("x < y", {0, 0, 0});
  EXPECT_THAT(scene.svg(), HasSubstr("<title>a &amp; b</title>"));
  EXPECT_THAT(scene.svg(), HasSubstr(">x &lt; y</text>"));
}

TEST(SvgScene, NothingFiniteIsAnEmptyPicture) {
  SvgScene scene("", 0.0, 0.0);
  scene.floor(0.0);
  scene.dot("red", Eigen::Vector3d::Constant(std::nan("")), 4.0);
  EXPECT_THAT(scene.svg(), Not(HasSubstr("nan")));
  EXPECT_THAT(scene.svg(), Not(HasSubstr("inf")));
  EXPECT_THROW(scene.line("red", Eigen::Matrix3Xd::Zero(3, 1), 1.0), ContractError);
  EXPECT_THROW(SvgScene("", 0.0, 91.0), ContractError);
}

}  // namespace
}  // namespace kinemark::studies

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/recording_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/simulation/sleeve_room.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

TEST(RecordingFigures, AreNumberedAndShowTheirParts) {
  const auto figures = recording_figures(4);
  ASSERT_TRUE(figures) << figures.error().message;
  ASSERT_EQ(figures->size(), 4U);
  const std::vector<std::vector<const char*>> parts{{"camera 6", "sleeve"},
                                                    {">u0<", ">f7<", "shoulder"},
                                                    {" mm</text>", "elbow"},
                                                    {"LED", "240 Hz", "60 Hz"}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ((*figures)[i].number, static_cast<int>(i + 1));
    const auto svg = report::figure_svg((*figures)[i].figure);
    for (const char* part : parts[i]) EXPECT_THAT(svg, HasSubstr(part));
  }
}

TEST(RecordingFigures, CamerasAreThoseThatSeeTheSleeve) {
  const auto figures = recording_figures(4).value();
  const auto room = simulation::sleeve_room();
  for (std::size_t c = 0; c < room.cameras.size(); ++c)
    EXPECT_EQ(Eigen::Vector3d(figures[0].curves[0].points.row(static_cast<Eigen::Index>(c))),
              room.cameras[c]);
}

TEST(RecordingFigures, DistancesFromTheElbowStay) {
  const auto figures = recording_figures(4).value();
  ASSERT_EQ(figures[2].curves.size(), 6U);
  for (const auto& curve : figures[2].curves) {
    const Eigen::VectorXd mm = curve.points.col(1);
    EXPECT_LT(mm.maxCoeff() - mm.minCoeff(), 1e-6) << curve.name;
    EXPECT_GT(mm[0], 15.0) << curve.name;
  }
}

TEST(RecordingFigures, TheStreamHasFourTimesTheCamerasRate) {
  const auto figures = recording_figures(4).value();
  EXPECT_EQ(figures[3].numbers.front().ours, 240.0);
  const auto& points = figures[3].curves.front().points;
  EXPECT_NEAR(points(1, 0) - points(0, 0), 1.0 / 240.0, 1e-9);
}

TEST(RecordedArm, IsDrawnFromMarkersAlone) {
  const auto figure = recorded_arm(4);
  ASSERT_TRUE(figure) << figure.error().message;
  EXPECT_EQ(figure->number, 7);
  EXPECT_EQ(figure->curves.size(), 12U) << "elbow, shoulder, wrist in four postures";
  const auto svg = report::figure_svg(figure->figure);
  EXPECT_THAT(svg, HasSubstr("stroke=\"#000000\""));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#b8b8b8\"")) << "the shadow";
  EXPECT_THAT(svg, HasSubstr("Squares of the floor"));
}

}  // namespace
}  // namespace kinemark::studies

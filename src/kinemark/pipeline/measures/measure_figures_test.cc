// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measure_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

// Patterns of fonts that fontconfig keeps for Cairo.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

MeasuresOutcome outcome() {
  MeasuresOutcome out;
  out.measures.push_back({.id = "path_length",
                          .subject = "RFIN",
                          .quantity = data::Quantity::length,
                          .value = 0.34,
                          .interval = {.kind = data::IntervalKind::two_sided, .low = 0.33, .high = 0.35}});
  out.measures.push_back(
      {.id = "onset", .subject = "</script><b>", .quantity = data::Quantity::time, .remark = "no movement"});
  out.warnings.emplace_back("LFIN was measured in 3 frames; need 30 at least");
  return out;
}

TEST(MeasuresPage, HoldsTheTableTheFiguresAndWhatStandsOut) {
  const auto page = measures_page({.input = "sign.c3d"}, outcome(),
                                  {{"RFIN_path", {.title = "RFIN: path", .panels = {{}}}}});
  for (const char* part : {"\"kind\":\"measures\"", "Path length", "340 [330 to 350] mm", "RFIN: path",
                           "measure not determined", "LFIN was measured in 3 frames", "\"markers\":2"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(MeasuresPage, IsHeadedByWhatItIsOf) {
  const auto heading = [](workflow::MeasuresOf of) {
    MeasuresJob job{.input = "sign.c3d"};
    job.of = of;
    const auto page = measures_page(job, outcome(), {});
    return page.substr(page.find("\"heading\":\""), 80);
  };
  EXPECT_THAT(heading(workflow::MeasuresOf::paths), HasSubstr("\"Paths of markers\",\"rows\":\"Marker\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::muscles), HasSubstr("\"Electromyograms\",\"rows\":\"Channel\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::walking), HasSubstr("\"Walking and force plates\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::everything), HasSubstr("\"All measures of a recording\""));
}

TEST(MeasuresPage, NamesAreTextInIt) {
  const auto page = measures_page({.input = "sign.c3d"}, outcome(), {});
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
}

using ::testing::HasSubstr;

// A circle of 100 mm, three times in three seconds.
analysis::PathCurves wheel() {
  analysis::PathCurves out{.subject = "R FIN/1", .rate_hz = 100.0, .start_s = 0.5, .cut_off_hz = 8.0};
  out.along.resize(300, 3);
  for (Eigen::Index i = 0; i < 300; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / 100.0;
    out.along.row(i) << 0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0;
  }
  out.speed = Eigen::VectorXd::Constant(300, 0.2 * std::numbers::pi);
  out.acceleration = Eigen::VectorXd::Zero(300);
  out.speed_sd = Eigen::VectorXd::Constant(300, 0.01);
  out.acceleration_sd = Eigen::VectorXd::Constant(300, 0.1);
  out.measured.assign(300, true);
  out.cycles = {0.1, 1.1, 2.1};
  return out;
}

TEST(MeasureFigures, ThePathIsShownInItsPlaneWithAxesAndBox) {
  const auto figures = measure_figures(wheel());
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_EQ(figures[0].name, "R_FIN_1_path");
  const auto svg = report::figure_svg(figures[0].figure);
  EXPECT_THAT(svg, HasSubstr("R FIN/1, 0.500 to 3.490 s: path in its best-fit plane"));
  EXPECT_THAT(svg, HasSubstr("extent 200 x 200 mm"));
  EXPECT_THAT(svg, HasSubstr("smoothed to 8 Hz<"));
  ASSERT_EQ(figures[0].figure.panels.size(), 2u);
  EXPECT_TRUE(figures[0].figure.panels[0].equal);
  // Two deviations of a circle are its radius times the root of 2.
  const auto& axis = figures[0].figure.panels[0].lines[1];
  EXPECT_NEAR(axis.x[1], 100.0 * std::numbers::sqrt2, 1e-6);
}

TEST(MeasureFigures, SpeedHasItsDeviationAndMarks) {
  auto curves = wheel();
  curves.window = {.onset_s = 0.2, .end_s = 2.5};
  const auto figure = measure_figures(curves)[1].figure;
  ASSERT_EQ(figure.panels.size(), 2u);
  ASSERT_EQ(figure.panels[0].bands.size(), 1u);
  EXPECT_NEAR(figure.panels[0].bands[0].high[7] - figure.panels[0].lines[0].y[7], 10.0, 1e-9);
  EXPECT_EQ(figure.panels[0].marks.size(), 5u);
  EXPECT_NEAR(figure.panels[0].marks[0].x, 0.7, 1e-12);
  curves.speed_sd.resize(0);
  EXPECT_TRUE(measure_figures(curves)[1].figure.panels[0].bands.empty());
}

TEST(MeasureFigures, WhatWasNotMeasuredIsGreyAndSaid) {
  auto curves = wheel();
  for (std::size_t i = 100; i < 110; ++i) curves.measured[i] = false;
  const auto figure = measure_figures(curves)[1].figure;
  EXPECT_EQ(figure.caption, "smoothed to 8 Hz; 10 of 300 samples were not measured (grey)");
  ASSERT_EQ(figure.panels[0].lines.size(), 2u);
  EXPECT_TRUE(std::isnan(figure.panels[0].lines[0].y[104]));
  EXPECT_FALSE(std::isnan(figure.panels[0].lines[1].y[104]));
  EXPECT_FALSE(std::isnan(figure.panels[0].lines[1].y[99]));
  EXPECT_TRUE(std::isnan(figure.panels[0].lines[1].y[98]));
}

TEST(MeasureFigures, CyclesAreLaidOverEachOther) {
  auto curves = wheel();
  const auto figures = measure_figures(curves);
  EXPECT_EQ(figures[2].name, "R_FIN_1_cycles");
  const auto& panel = figures[2].figure.panels[0];
  ASSERT_EQ(panel.lines.size(), 3u);  // two cycles and their mean
  EXPECT_EQ(panel.lines[2].name, "mean of 2 cycles");
  EXPECT_NEAR(panel.lines[2].y[0], 100.0 * std::cos(0.2 * std::numbers::pi), 1e-6);
  EXPECT_NEAR((panel.bands[0].high - panel.bands[0].low).maxCoeff(), 0.0, 1e-6);
  curves.cycles = {0.1};
  EXPECT_EQ(measure_figures(curves).size(), 2u);
}

TEST(MeasureFigures, FormatsAreThoseThatThereAre) {
  EXPECT_EQ(*parse_figure_formats("svg"), (std::vector<std::string>{"svg"}));
  EXPECT_EQ(parse_figure_formats("svg,pdf").error().message,
            "--figure-formats: 'pdf' is none of svg and png");
  EXPECT_THAT(*parse_figure_formats(""), ::testing::Contains("svg"));
  EXPECT_THAT(*figure_file({.title = "t", .panels = {{}}}, "svg"), ::testing::StartsWith("<svg"));
}

}  // namespace

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

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

FigurePanel small(const std::string& title) {
  FigurePanel out{.title = title, .note = "12 % missing", .y_label = "deg", .y_up = "up", .y_down = "down"};
  out.lines.push_back(
      {.colour = "#d55e00", .x = Eigen::Vector2d(0.0, 100.0), .y = Eigen::Vector2d(-1.0, 1.0), .width = 2.5});
  return out;
}

// Where a text stands; fails where it is not there.
Eigen::Vector2d place_of(const std::string& svg, const std::string& words) {
  const auto end = svg.find(">" + words + "</text>");
  EXPECT_NE(end, std::string::npos) << words;
  if (end == std::string::npos) return {0.0, 0.0};
  double x = 0.0, y = 0.0;
  const auto at = svg.rfind("<text ", end);
  EXPECT_EQ(std::sscanf(svg.c_str() + at, "<text x=\"%lf\" y=\"%lf\"", &x, &y), 2) << words;
  return {x, y};
}

TEST(Figure, PanelsStandInAGridWithPositionsThatStayFree) {
  const auto svg =
      figure_svg({.panels = {small("one"), {.title = "nobody", .blank = true}, small("three"), small("four")},
                  .width = 840.0,
                  .columns = 3,
                  .panel_height = 100.0});
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 840 "));
  EXPECT_THAT(svg, Not(HasSubstr("nobody")));
  const auto one = place_of(svg, "one"), three = place_of(svg, "three"), four = place_of(svg, "four");
  EXPECT_NEAR(three.x() - one.x(), 560.0, 1e-6);
  EXPECT_EQ(three.y(), one.y());
  EXPECT_EQ(four.x(), one.x());
  EXPECT_GT(four.y(), one.y() + 100.0);
  EXPECT_EQ(times(svg, ">12 % missing</text>"), 3u);
  EXPECT_EQ(times(svg, ">up</text>"), 3u);
  EXPECT_EQ(times(svg, ">down</text>"), 3u);
  EXPECT_THAT(svg, HasSubstr("font-weight=\"bold\""));
}

TEST(Figure, ALongNoteOfAPanelGoesOnBelow) {
  auto long_note = small("one");
  long_note.note = "a note that is much too long for the width of its panel, which is narrow";
  const Figure figure{
      .panels = {long_note, small("two")}, .width = 400.0, .columns = 2, .panel_height = 100.0};
  const auto svg = figure_svg(figure);
  EXPECT_THAT(svg, Not(HasSubstr(long_note.note)));
  EXPECT_THAT(svg, HasSubstr("narrow</text>"));
  EXPECT_EQ(place_of(svg, "one").y(), place_of(svg, "two").y());
}

// Left and right end of the line of this width.
std::pair<double, double> ends_of(const std::string& svg, const std::string& width) {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  const auto at = svg.find("stroke-width=\"" + width + "\" d=\"M");
  EXPECT_NE(at, std::string::npos);
  if (at == std::string::npos) return {};
  EXPECT_EQ(std::sscanf(svg.c_str() + svg.find("d=\"M", at) + 3, "M%lf %lfL%lf %lf", &x0, &y0, &x1, &y1), 4);
  return {x0, x1};
}

TEST(Figure, ATightAxisEndsWhereItsCurvesDo) {
  auto panel = small("one");
  const auto loose = ends_of(figure_svg({.panels = {panel}}), "2.5");
  EXPECT_GT(loose.first, 72.5);
  panel.tight = true;
  const auto tight = ends_of(figure_svg({.panels = {panel}}), "2.5");
  EXPECT_NEAR(tight.first, 72.0, 1e-9);
  EXPECT_NEAR(tight.second, 620.0, 1e-9);
}

TEST(Figure, AxesReachToWhereNothingIsDrawn) {
  auto panel = small("one");
  panel.room.emplace_back(300.0, 0.0);
  const auto ends = ends_of(figure_svg({.panels = {panel}}), "2.5");
  EXPECT_LT(ends.second, 72.0 + 0.4 * 548.0);
}

TEST(Figure, AreasLieBelowBandsAndLines) {
  auto panel = small("one");
  panel.areas.push_back({.name = "spread",
                         .colour = "#aabbcc",
                         .x = Eigen::Vector3d(0.0, 50.0, 100.0),
                         .y = Eigen::Vector3d(0.0, 1.0, 0.0)});
  const auto svg = figure_svg({.panels = {panel}});
  const auto area = svg.find("fill=\"#aabbcc\" fill-opacity=\"1\"");
  ASSERT_NE(area, std::string::npos);
  EXPECT_LT(area, svg.find("stroke-width=\"2.5\""));
  EXPECT_THAT(svg, HasSubstr(">spread</text>"));
}

TEST(Figure, LinesAreDottedOrDashed) {
  auto panel = small("one");
  panel.lines[0].dotted = true;
  EXPECT_THAT(figure_svg({.panels = {panel}}), HasSubstr("stroke-dasharray=\"2.5 5\""));
  panel.lines[0].dotted = false;
  panel.lines[0].dashed = true;
  EXPECT_THAT(figure_svg({.panels = {panel}}), HasSubstr("stroke-dasharray=\"6 4\""));
}

TEST(Figure, ZeroIsDrawnWhereItIsWithin) {
  auto panel = small("one");
  const auto plain = times(figure_svg({.panels = {panel}}), "#a8a8a8");
  panel.zero = true;
  EXPECT_EQ(times(figure_svg({.panels = {panel}}), "#a8a8a8"), plain + 1);
  panel.lines[0].y = Eigen::Vector2d(5.0, 6.0);
  EXPECT_EQ(times(figure_svg({.panels = {panel}}), "#a8a8a8"), plain);
}

TEST(Figure, SymbolsMarkPositionsAndStandInTheLegend) {
  auto panel = small("one");
  panel.symbols.push_back({.name = "strike", .colour = "#123456", .at = {10.0, 0.0}});
  panel.symbols.push_back({.shape = SymbolShape::ring, .colour = "#234567", .at = {20.0, 0.0}});
  panel.symbols.push_back(
      {.shape = SymbolShape::arrow, .colour = "#345678", .at = {50.0, 0.0}, .towards = {1.0, 0.0}});
  panel.symbols.push_back(
      {.shape = SymbolShape::arrow, .colour = "#456789", .at = {50.0, 0.0}, .towards = {0.0, 0.0}});
  panel.symbols.push_back({.colour = "#56789a", .at = {std::nan(""), 0.0}});
  const auto svg = figure_svg({.panels = {panel}});
  EXPECT_EQ(times(svg, "fill=\"#123456\""), 2u);  // at its place and in the legend
  EXPECT_THAT(svg, HasSubstr(">strike</text>"));
  EXPECT_EQ(times(svg, "<circle"), 2u * 2u + 3u);  // discs with a white rim; the ring's inside
  EXPECT_EQ(times(svg, "fill=\"#345678\""), 1u);
  EXPECT_THAT(svg, Not(HasSubstr("#456789")));  // points nowhere
  EXPECT_THAT(svg, Not(HasSubstr("#56789a")));
}

TEST(Figure, AnArrowPointsAlongTheCurveOnThePicture) {
  auto panel = small("one");
  panel.symbols.push_back(
      {.shape = SymbolShape::arrow, .colour = "#345678", .at = {50.0, 0.0}, .towards = {0.0, 1.0}});
  const auto svg = figure_svg({.panels = {panel}});
  const auto at = svg.find("d=\"M", svg.find("fill=\"#345678\""));
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(svg.c_str() + at + 3, "M%lf %lfL%lf %lfL%lf %lf", x, y, x + 1, y + 1, x + 2, y + 2),
            6);
  EXPECT_NEAR(x[1] + x[2], 2.0 * x[0], 0.02);  // upright
  EXPECT_GT(y[1], y[0]);                       // its tip above its base
}

TEST(Figure, KeysAndNotesStandOnce) {
  const std::string note =
      "A sentence that is far too long for one line of a narrow figure and so goes on below it.";
  const auto svg = figure_svg({.caption = "below",
                               .panels = {small("one")},
                               .width = 400.0,
                               .keys = {{.name = "left", .colour = "#d55e00"},
                                        {.name = "norm", .colour = "#9a9a9a", .band = true, .opacity = 0.35}},
                               .notes = {note}});
  EXPECT_EQ(times(svg, ">left</text>"), 1u);
  EXPECT_THAT(svg, HasSubstr("fill=\"#9a9a9a\" fill-opacity=\"0.35\""));
  EXPECT_LT(place_of(svg, "left").y(), 40.0);
  EXPECT_THAT(svg, Not(HasSubstr(note)));
  EXPECT_THAT(svg, HasSubstr(">A sentence that is far"));
  EXPECT_THAT(svg, HasSubstr("goes on below it.</text>"));
}

TEST(Figure, TintsAreColoursOnWhitePaper) {
  EXPECT_EQ(tint("#000000", 1.0), "#000000");
  EXPECT_EQ(tint("#000000", 0.0), "#ffffff");
  EXPECT_EQ(tint("#ff8000", 0.5), "#ffc080");
  EXPECT_EQ(tint("#123456", 7.0), "#123456");
}

TEST(Figure, APictureStandsInThePlaceOfAxes) {
  Figure figure;
  FigurePanel panel;
  panel.height = 100.0;
  CanvasRoom seen;
  panel.picture = [&seen](Canvas& canvas, const CanvasRoom& room) {
    seen = room;
    canvas.text({room.left, room.bottom}, "drawn by itself", {.halo = true});
  };
  figure.panels.push_back(panel);
  const auto svg = figure_svg(figure);
  EXPECT_NE(svg.find(">drawn by itself<"), std::string::npos);
  EXPECT_NE(svg.find("paint-order=\"stroke\""), std::string::npos) << "a halo";
  EXPECT_EQ(svg.find("<path"), std::string::npos) << "no axes";
  EXPECT_DOUBLE_EQ(seen.bottom - seen.top, 100.0);
  EXPECT_GT(seen.right - seen.left, 600.0);
}

TEST(Figure, ALogarithmicPanelLeavesOutWhatIsNotPositive) {
  Figure figure;
  FigurePanel panel{.logarithmic = true};
  panel.lines.push_back(
      {.colour = "#123456", .x = Eigen::Vector4d(0, 1, 2, 3), .y = Eigen::Vector4d(0, 1, 10, 100)});
  figure.panels.push_back(panel);
  const auto svg = figure_svg(figure);
  const auto line = svg.substr(svg.find("#123456"), 200);
  double y[3], x[3];
  const auto d = line.find(" d=\"M");
  ASSERT_EQ(std::sscanf(line.c_str() + d, " d=\"M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0], &x[1], &y[1], &x[2],
                        &y[2]),
            6);
  EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.02) << "ten times as much is as far each time";
}

}  // namespace
}  // namespace kinemark::report

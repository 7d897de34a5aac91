// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/canvas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

// Patterns of fonts that fontconfig keeps for Cairo.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Points = std::vector<Eigen::Vector2d>;

std::string svg_of(const std::function<void(Canvas&)>& draw) {
  const auto canvas = make_svg_canvas(100.0, 50.0, "title");
  draw(*canvas);
  return canvas->finish().value();
}

TEST(SvgCanvas, IsAWholeFileOnWhite) {
  const auto svg = svg_of([](Canvas&) {});
  EXPECT_THAT(
      svg,
      ::testing::StartsWith(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 50\" width=\"100\" height=\"50\""));
  EXPECT_THAT(svg, HasSubstr("<title>title</title><rect width=\"100\" height=\"50\" fill=\"#ffffff\"/>"));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
}

TEST(SvgCanvas, LinesArePathsWithTheirStroke) {
  const auto svg = svg_of([](Canvas& canvas) {
    canvas.line(Points{{1.0, 2.0}, {3.0, 4.5}}, {.colour = "#123456", .width = 2.5});
    canvas.line(Points{{0.0, 0.0}, {9.0, 9.0}}, {.dashed = true});
  });
  EXPECT_THAT(
      svg,
      HasSubstr("<path fill=\"none\" stroke=\"#123456\" stroke-width=\"2.5\" d=\"M1.00 2.00L3.00 4.50\"/>"));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray=\"6 4\""));
}

TEST(SvgCanvas, WhatIsTooShortIsNotDrawn) {
  const auto svg = svg_of([](Canvas& canvas) {
    canvas.line(Points{{1.0, 2.0}}, {});
    canvas.line(Points{}, {});
    canvas.area(Points{{1.0, 2.0}, {3.0, 4.0}}, "#000000", 0.5);
  });
  EXPECT_THAT(svg, Not(HasSubstr("<path")));
}

TEST(SvgCanvas, AreasAreClosedAndDotsAreCircles) {
  const auto svg = svg_of([](Canvas& canvas) {
    canvas.area(Points{{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}}, "#00ff00", 0.25);
    canvas.dot({7.0, 8.0}, 2.2, "#ff0000");
  });
  EXPECT_THAT(
      svg, HasSubstr("<path fill=\"#00ff00\" fill-opacity=\"0.25\" d=\"M0.00 0.00L4.00 0.00L4.00 3.00Z\"/>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"7.00\" cy=\"8.00\" r=\"2.2\" fill=\"#ff0000\"/>"));
}

TEST(SvgCanvas, TextIsTextWhateverItHolds) {
  const auto svg = svg_of([](Canvas& canvas) {
    canvas.text({5.0, 6.0}, "a < b & \"c\"", {.size = 11.0, .anchor = Anchor::middle, .colour = "#222222"});
    canvas.text({1.0, 2.0}, "end", {.anchor = Anchor::end});
    canvas.text({3.0, 4.0}, "up", {.upwards = true});
  });
  EXPECT_THAT(svg, HasSubstr("<text x=\"5.00\" y=\"6.00\" font-size=\"11\" text-anchor=\"middle\" "
                             "fill=\"#222222\">a &lt; b &amp; "));
  EXPECT_THAT(svg, HasSubstr("text-anchor=\"end\""));
  EXPECT_THAT(svg, HasSubstr("<text transform=\"translate(3.00 4.00) rotate(-90)\""));
  EXPECT_THAT(svg_of([](Canvas& canvas) { canvas.text({0.0, 0.0}, "<script>", {}); }),
              Not(HasSubstr("<script>")));
}

// The picture of a PNG that Cairo wrote; empty where the program was built without it.
std::string png_of(double width, double height, double scale, const std::function<void(Canvas&)>& draw) {
  auto canvas = make_png_canvas(width, height, scale);
  if (!canvas) {
    EXPECT_EQ(canvas.error().code, Code::not_supported);
    return {};
  }
  draw(**canvas);
  return (*canvas)->finish().value();
}

unsigned number_at(const std::string& png, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(png[at + i]);
  return value;
}

TEST(PngCanvas, HasTheDotsThatWereAskedFor) {
  const auto png = png_of(100.0, 50.0, 3.0, [](Canvas&) {});
  if (png.empty()) GTEST_SKIP() << "built without Cairo";
  EXPECT_EQ(number_at(png, 16), 300u);
  EXPECT_EQ(number_at(png, 20), 150u);
}

TEST(PngCanvas, SameDrawingSameBytesAndOtherDrawingOtherBytes) {
  const auto line = [](double to) {
    return png_of(60.0, 40.0, 1.0, [to](Canvas& canvas) {
      canvas.line(Points{{5.0, 5.0}, {to, 30.0}}, {.colour = "#0072b2", .width = 2.0, .dashed = true});
      canvas.area(Points{{1.0, 1.0}, {20.0, 1.0}, {20.0, 20.0}}, "#d55e00", 0.2);
      canvas.dot({30.0, 20.0}, 3.0, "#000000");
      canvas.text({10.0, 38.0}, "words", {.anchor = Anchor::middle});
    });
  };
  if (line(50.0).empty()) GTEST_SKIP() << "built without Cairo";
  EXPECT_EQ(line(50.0), line(50.0));
  EXPECT_NE(line(50.0), line(40.0));
}

TEST(PngCanvas, SizesThatAreNoneAreRefused) {
  if (png_of(1.0, 1.0, 1.0, [](Canvas&) {}).empty()) GTEST_SKIP() << "built without Cairo";
  for (const std::array<double, 3> size :
       {std::array{0.0, 10.0, 1.0}, std::array{10.0, -1.0, 1.0}, std::array{10.0, 10.0, 0.0},
        std::array{1e5, 10.0, 1.0}, std::array{std::nan(""), 10.0, 1.0}}) {
    const auto canvas = make_png_canvas(size[0], size[1], size[2]);
    ASSERT_FALSE(canvas);
    EXPECT_EQ(canvas.error().code, Code::bad_input);
    EXPECT_THAT(canvas.error().message, HasSubstr("need 1 to 20000"));
  }
}

}  // namespace
}  // namespace kinemark::report

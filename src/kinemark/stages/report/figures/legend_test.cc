// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/internal/legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::report::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Legend, WidthCountsLettersNotBytes) {
  EXPECT_DOUBLE_EQ(text_width("abc", 10.0), text_width("\u00b1\u00b1\u00b1", 10.0));
  EXPECT_DOUBLE_EQ(text_width("abc", 20.0), 2.0 * text_width("abc", 10.0));
  EXPECT_EQ(text_width("", 10.0), 0.0);
}

TEST(Legend, TextBreaksAtBlanks) {
  const double four = text_width("four", 10.0);
  EXPECT_THAT(broken_text("four four four", 10.0, four), ElementsAre("four", "four", "four"));
  EXPECT_THAT(broken_text("four four four", 10.0, 1000.0), ElementsAre("four four four"));
  EXPECT_THAT(broken_text("a wordthatdoesnotfit b", 10.0, four), ElementsAre("a", "wordthatdoesnotfit", "b"));
  EXPECT_TRUE(broken_text("", 10.0, four).empty());
}

TEST(Legend, IsAsHighAsItHasLines) {
  EXPECT_EQ(Legend(std::vector<FigureKey>{}, 500.0).height(), 0.0);
  const std::vector<FigureKey> two{{.name = "a", .colour = "#000000"}, {.name = "b", .colour = "#000000"}};
  EXPECT_EQ(Legend(two, 500.0).height(), 16.0);
  EXPECT_EQ(Legend(two, 40.0).height(), 32.0);
}

TEST(Legend, NamesOnlyWhatHasAName) {
  FigurePanel panel;
  panel.lines.push_back({.colour = "#000000"});
  panel.lines.push_back({.name = "mean", .colour = "#000000", .dotted = true});
  panel.symbols.push_back({.shape = SymbolShape::ring, .name = "toe-off", .colour = "#000000"});
  panel.areas.push_back({.name = "spread", .colour = "#cccccc"});
  const auto canvas = make_svg_canvas(300.0, 100.0, "");
  Legend(panel, 300.0).draw(*canvas, {10.0, 10.0});
  const auto svg = *canvas->finish();
  for (const char* word : {">mean<", ">toe-off<", ">spread<", "stroke-dasharray=\"2 4\""})
    EXPECT_THAT(svg, HasSubstr(word));
  EXPECT_LT(svg.find("spread"), svg.find("mean"));
}

TEST(Legend, SymbolsAreDrawnInTheirShape) {
  const auto drawn = [](SymbolShape shape) {
    const auto canvas = make_svg_canvas(100.0, 100.0, "");
    draw_symbol(*canvas, shape, {50.0, 50.0}, {0.0, -2.0}, "#123456");
    return *canvas->finish();
  };
  const auto count = [](const std::string& svg) {
    std::size_t n = 0;
    for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count(drawn(SymbolShape::disc)), 2u);
  EXPECT_EQ(count(drawn(SymbolShape::ring)), 3u);
  EXPECT_EQ(count(drawn(SymbolShape::arrow)), 0u);
  EXPECT_THAT(drawn(SymbolShape::arrow), HasSubstr("d=\"M50.00 50.00L"));
}

}  // namespace
}  // namespace kinemark::report::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/canvas.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::screens {
namespace {

TEST(Canvas, TextIsCutAtItsWidthAndAtTheEdge) {
  Canvas canvas(3, 8);
  canvas.text(0, 0, "é is one", Ink::bold);
  canvas.text(1, 1, "too long", Ink::plain, 4);
  canvas.text(2, 6, "edge");
  canvas.text(7, 0, "outside");
  canvas.text(0, 9, "outside");
  EXPECT_EQ(canvas.to_text(), "é is one\n too…\n      e…\n");
  EXPECT_EQ(canvas.at(0, 3).ink, Ink::bold);
  EXPECT_EQ(canvas.at(1, 0).ink, Ink::plain);
}

TEST(Canvas, ControlCharactersReachNoTerminal) {
  Canvas canvas(1, 12);
  canvas.text(0, 0, "a\x1b[2Jb\nc");
  EXPECT_EQ(canvas.to_text().find('\x1b'), std::string::npos);
  EXPECT_EQ(canvas.at(0, 0).glyph, U'a');
}

TEST(Canvas, BoxHasItsTitleInTheUpperEdge) {
  Canvas canvas(3, 10);
  canvas.box(0, 0, 3, 10, "A");
  EXPECT_EQ(canvas.to_text(), "┌─ A ────┐\n│        │\n└────────┘\n");
}

TEST(Canvas, DotsAreBrailleTwoByFour) {
  Canvas canvas(1, 2);
  const std::vector<Eigen::Vector2d> corners = {{-1, -1}, {1, 1}, {0.0, -1.0}, {NAN, 0}, {1.1, 0}};
  canvas.dots(0, 0, 1, 2, corners);
  EXPECT_EQ(canvas.at(0, 0).glyph, char32_t{0x2801});  // upper left dot
  EXPECT_EQ(canvas.at(0, 1).glyph,
            char32_t{0x2800 + 0x80 + 0x01});  // lower right, and upper left of the second
}

TEST(Canvas, DotsOfTwoCallsAddUp) {
  Canvas canvas(1, 1);
  const std::vector<Eigen::Vector2d> first = {{-1, -1}}, second = {{0.5, 1}};
  canvas.dots(0, 0, 1, 1, first);
  canvas.dots(0, 0, 1, 1, second);
  EXPECT_EQ(canvas.at(0, 0).glyph, char32_t{0x2881});
}

TEST(Canvas, BarIsFilledToItsShare) {
  Canvas canvas(3, 4);
  canvas.bar(0, 0, 4, 0.5);
  canvas.bar(1, 0, 4, 7.0);
  canvas.bar(2, 0, 4, std::nan(""));
  EXPECT_EQ(canvas.to_text(), "██··\n████\n\n");
}

}  // namespace
}  // namespace kinemark::screens

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kinemark {
namespace {

TEST(ParseNumber, ReadsWhatRealFilesContain) {
  EXPECT_EQ(parse_number("1.25"), 1.25);
  EXPECT_EQ(parse_number("  -2.73E-01\r"), -0.273);
  EXPECT_EQ(parse_number("+3"), 3.0);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("5."), 5.0);
  for (const char* nan : {"NaN", "nan", "NAN", "-nan", "       NaN"})
    EXPECT_TRUE(std::isnan(parse_number(nan).value())) << nan;
  EXPECT_EQ(parse_number("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-Infinity"), -std::numeric_limits<double>::infinity());
}

TEST(ParseNumber, RefusesEverythingElse) {
  for (const char* text : {"", " ", "x", "1.2.3", "1,5", "12 13", "0x10", "+-3", "--3", "1e", "nanx"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(FormatNumber, ReadsBackExactly) {
  for (const double value : {0.0, -0.1, 1.0 / 3.0, 1e-300, 1e300, 123456789.123456789, 5e-324})
    EXPECT_EQ(parse_number(format_number(value)), value);
  EXPECT_EQ(format_number(0.5), "0.5");
  EXPECT_EQ(format_number(std::nan("")), "nan");
}

TEST(Trim, TakesBlanksOffBothEnds) {
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim("  "), "");
}

}  // namespace
}  // namespace kinemark

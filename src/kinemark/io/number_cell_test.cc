// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/number_cell.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

TEST(NumberCell, IsOfOneKind) {
  for (const char* cell : {"0", "-12", "1e5", "NaN"}) EXPECT_EQ(number_in(cell), Number::whole) << cell;
  for (const char* cell : {"1.5", "-.5", "0.123", "1234.567", "1.2345"})
    EXPECT_EQ(number_in(cell), Number::with_point) << cell;
  for (const char* cell : {"1,5", "0,123", "1234,567", "-,5"})
    EXPECT_EQ(number_in(cell), Number::with_comma) << cell;
  for (const char* cell : {"1.234", "-12.345", "+123.456"})
    EXPECT_EQ(number_in(cell), Number::three_behind_point) << cell;
  EXPECT_EQ(number_in("1,234"), Number::three_behind_comma);
  for (const char* cell : {"1,234.5", "-1,234,567", "12,345,678.25"})
    EXPECT_EQ(number_in(cell), Number::groups_with_commas) << cell;
  for (const char* cell : {"1.234,5", "1.234.567", "-12.345.678,25"})
    EXPECT_EQ(number_in(cell), Number::groups_with_points) << cell;
  for (const char* cell : {"", "a", "1,2,3", "1,23.5", "1.234,5,6", "1,2345.6", ",", "1,", "1'234"})
    EXPECT_EQ(number_in(cell), Number::none) << cell;
}

TEST(NumberCell, UsualSignsTakeThePlaceOfOthers) {
  EXPECT_EQ(with_usual_signs("\xE2\x88\x92"
                             "1'234.5"),
            "-1234.5");
  EXPECT_EQ(with_usual_signs("1 234 567,5"), "1234567,5");
  EXPECT_EQ(with_usual_signs("0.12D+02"), "0.12e+02");
  for (const char* cell : {"1 23", "1 2345", "a 123", "1.5 234", "12 mm", "D2", "marker D1"})
    EXPECT_EQ(with_usual_signs(cell), cell);
}

NumberKinds kinds_of(const std::vector<std::vector<std::string>>& rows) {
  NumberKinds out;
  for (const auto& cells : rows) {
    std::vector<std::pair<Number, std::string>> row;
    for (const auto& cell : cells) row.emplace_back(number_in(cell), cell);
    out.add(row);
  }
  return out;
}

TEST(NumberKinds, TellThousandsFromPartsOfOne) {
  EXPECT_EQ(kinds_of({{"1.5", "2.25"}}).thousands(), 0);
  EXPECT_EQ(kinds_of({{"1,234.5", "2"}}).thousands(), ',');
  EXPECT_EQ(kinds_of({{"1.234,5", "2"}}).thousands(), '.');
  EXPECT_EQ(kinds_of({{"1,234", "0.5"}}).thousands(), ',') << "another number has a point";
  EXPECT_EQ(kinds_of({{"1,234", "0,5"}}).thousands(), 0);
  EXPECT_EQ(kinds_of({{"987", "1"}, {"1.012", "1"}}).thousands(), '.') << "the column goes on";
  EXPECT_EQ(kinds_of({{"9.871", "987"}, {"1.012", "988"}}).thousands(), 0) << "another column does";
  EXPECT_EQ(kinds_of({{"1,234.5", "1.234,5"}}).thousands(), 0) << "they contradict each other";
}

TEST(NumberKinds, HaveDecimalCommasWhereNoNumberHasAPoint) {
  EXPECT_TRUE(kinds_of({{"1,5", "2"}}).have_decimal_commas());
  EXPECT_TRUE(kinds_of({{"1.234,5", "2"}}).have_decimal_commas());
  EXPECT_TRUE(kinds_of({{"1,234", "2"}}).have_decimal_commas());
  EXPECT_FALSE(kinds_of({{"1,5", "2.5"}}).have_decimal_commas());
  EXPECT_FALSE(kinds_of({{"1,234.5", "2"}}).have_decimal_commas());
  EXPECT_FALSE(kinds_of({{"1.5", "2"}}).have_decimal_commas());
}

}  // namespace
}  // namespace kinemark::io

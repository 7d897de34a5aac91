// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace kinemark::io::internal {
namespace {

using testing::ElementsAre;

std::vector<std::string> all_lines(std::string_view text) {
  Lines lines(text);
  std::vector<std::string> out;
  for (std::string_view line; lines.next(line);) out.emplace_back(line);
  EXPECT_EQ(lines.number(), static_cast<std::int64_t>(out.size()));
  return out;
}

std::vector<std::string> all_texts(std::string_view line, Separator separator) {
  Cells cells(line, separator);
  std::vector<std::string> out;
  for (std::string_view cell; cells.next_text(cell);) out.emplace_back(cell);
  return out;
}

/// One letter per cell (number, blank, text) and the numbers.
std::string kinds(std::string_view line, Separator separator, std::vector<double>* numbers = nullptr) {
  Cells cells(line, separator);
  std::string out;
  double value = 0.0;
  for (Cell kind = cells.next(value); kind != Cell::none; kind = cells.next(value)) {
    out += kind == Cell::number ? 'n' : kind == Cell::blank ? 'b' : 't';
    if (kind == Cell::number && numbers != nullptr) numbers->push_back(value);
  }
  return out;
}

TEST(Lines, KnowsAllLineEnds) {
  EXPECT_THAT(all_lines("a\nb\n"), ElementsAre("a", "b"));
  EXPECT_THAT(all_lines("a\r\n\r\nb"), ElementsAre("a", "", "b"));
  EXPECT_THAT(all_lines("a\rb\r"), ElementsAre("a", "b"));
  EXPECT_THAT(all_lines("\xEF\xBB\xBF"
                        "a\n"),
              ElementsAre("a"));
  EXPECT_TRUE(all_lines("").empty());
}

TEST(Lines, CountsAheadWithoutMoving) {
  Lines lines("h\n1\n2\n \t\r\n3\n");
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(lines.count_until_blank(), 2);
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "1");
}

TEST(Cells, TabsSeparateBlankCellsToo) {
  EXPECT_EQ(kinds("1\t\t3", Separator::tab), "nbn");
  EXPECT_EQ(kinds("1\t 2 \t", Separator::tab), "nnb") << "a tab at the end promises one more cell";
  EXPECT_EQ(kinds("\t", Separator::tab), "bb");
  EXPECT_EQ(kinds("", Separator::tab), "b");
  EXPECT_EQ(kinds("1 2\t3", Separator::tab), "tn") << "two numbers in one cell are none";
  EXPECT_THAT(all_texts(" a b \tc\t", Separator::tab), ElementsAre("a b", "c", ""));
}

TEST(Cells, RunsOfBlanksSeparate) {
  EXPECT_EQ(kinds("  1   2\t3  ", Separator::blanks), "nnn");
  EXPECT_EQ(kinds("", Separator::blanks), "");
  EXPECT_EQ(kinds("1 x 2", Separator::blanks), "ntn");
  EXPECT_EQ(kinds("1 2,5 3", Separator::blanks), "ntn");
  EXPECT_THAT(all_texts(" a \t b", Separator::blanks), ElementsAre("a", "b"));
}

TEST(Cells, ReadsEverySpellingOfANumber) {
  std::vector<double> numbers;
  EXPECT_EQ(kinds("-2.73E-01\t+4\t  .5 \t5.\t1e3\t1e999\t-1.#INF", Separator::tab, &numbers), "nnnnnnn");
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(numbers, ElementsAre(-0.273, 4.0, 0.5, 5.0, 1000.0, inf, -inf));
}

TEST(Cells, ReadsEverySpellingOfNaN) {
  for (const char* cell :
       {"NaN",      "nan",       "NAN",     "Nan",       "-nan",     "+nan", "       NaN", "NaN   ",
        "nan(ind)", "-nan(ind)", "1.#QNAN", "-1.#IND00", "1.#SNAN0", "NA",   "N/A",        "n/a",
        "#N/A",     "None",      "NULL",    "null",      "<NA>",     "-"}) {
    std::vector<double> numbers;
    EXPECT_EQ(kinds(cell, Separator::tab, &numbers), "n") << cell;
    ASSERT_EQ(numbers.size(), 1U) << cell;
    EXPECT_TRUE(std::isnan(numbers[0])) << cell;
  }
}

TEST(Cells, RefusesWhatOnlyBeginsAsANumber) {
  for (const char* cell : {"1,5", "1.2.3", "12x", "0x10", "nanx", "1e", "+-3", "1.#IN", "1.#", "--", "#"})
    EXPECT_EQ(kinds(cell, Separator::tab), "t") << cell;
}

TEST(Cells, RemembersTheTextOfTheCellReadLast) {
  Cells cells(" 1.250 \tabc\t", Separator::tab);
  double value = 0.0;
  EXPECT_EQ(cells.next(value), Cell::number);
  EXPECT_EQ(cells.text(), "1.250");
  EXPECT_EQ(cells.next(value), Cell::text);
  EXPECT_EQ(cells.text(), "abc");
  EXPECT_EQ(value, 1.25) << "text leaves the value alone";
  EXPECT_EQ(cells.next(value), Cell::blank);
  EXPECT_EQ(cells.text(), "");
}

TEST(Excerpt, IsShortAndPrintable) {
  EXPECT_EQ(excerpt("a\tb\x01\xFF"), "a?b??");
  EXPECT_EQ(excerpt(std::string(100, 'x')), std::string(40, 'x') + "...");
}

}  // namespace
}  // namespace kinemark::io::internal

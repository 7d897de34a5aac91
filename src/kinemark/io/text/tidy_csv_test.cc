// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/tidy_csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

std::string sentence_of_table(std::string_view text) {
  const auto table = parse_tidy_csv(text, "t.csv");
  return table ? "" : table.error().message;
}

TEST(TidyCsv, NamesRowsAndQuotedCells) {
  const auto table = parse_tidy_csv(
      "# made by hand\nfile, subject ,value\n\"a, b.c3d\",S01,1.5\r\n\nc.c3d,\"S \"\"2\"\"\", nan\n",
      "t.csv");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->columns, (std::vector<std::string>{"file", "subject", "value"}));
  ASSERT_EQ(table->rows(), 2);
  EXPECT_EQ((*table)(0, 0), "a, b.c3d");
  EXPECT_EQ((*table)(1, 1), "S \"2\"");
  EXPECT_EQ(table->line_of, (std::vector<std::int64_t>{3, 5}));
  EXPECT_EQ(*table->number(0, 2), 1.5);
  EXPECT_TRUE(std::isnan(*table->number(1, 2)));
  EXPECT_EQ(table->find("subject"), 1);
  EXPECT_EQ(table->find("Subject"), -1);
}

TEST(TidyCsv, NumbersAloneAreRowsWhateverSeparatesThem) {
  for (const std::string text :
       {"1,2,3\n4,5,6\n", "1;2;3\n4;5;6", "1\t2\t3\n4\t5\t6\n", " 1 2  3\n4 5 6 \n"}) {
    const auto table = parse_tidy_csv(text, "y.txt");
    ASSERT_TRUE(table) << text;
    EXPECT_TRUE(table->columns.empty());
    EXPECT_EQ(table->width, 3) << text;
    ASSERT_EQ(table->rows(), 2);
    EXPECT_EQ(*table->number(1, 2), 6.0);
  }
}

TEST(TidyCsv, AnApostropheBeforeAFormulaIsNoneOfTheText) {
  const auto table = parse_tidy_csv("name,value\n'=A1,1\n''-x,2\n'toe,3\n", "t.csv");
  ASSERT_TRUE(table);
  EXPECT_EQ((*table)(0, 0), "=A1");
  EXPECT_EQ((*table)(1, 0), "'-x");
  EXPECT_EQ((*table)(2, 0), "'toe");
  EXPECT_TRUE(is_like_formula("@x") && is_like_formula("''+1"));
  EXPECT_FALSE(is_like_formula("x=1") || is_like_formula("'") || is_like_formula(""));
}

TEST(TidyCsv, BlankCellsAreNotDetermined) {
  const auto table = parse_tidy_csv("a;b\n;2\n", "t.csv");
  ASSERT_TRUE(table);
  EXPECT_TRUE(std::isnan(*table->number(0, 0)));
}

TEST(TidyCsv, WhatIsWrongIsSaidWithItsLine) {
  EXPECT_EQ(sentence_of_table(""), "t.csv: is empty; expected comma-separated values");
  EXPECT_EQ(sentence_of_table("a,b\n"), "t.csv: has a line of names and no row");
  EXPECT_EQ(sentence_of_table("a,b\n1,2\n3\n"), "t.csv: line 3: has 1 cells; the first line has 2");
  EXPECT_EQ(sentence_of_table("a,a\n1,2\n"), "t.csv: line 1: column 'a' occurs twice");
  EXPECT_EQ(sentence_of_table("a,,b\n1,2,3\n"), "t.csv: line 1: column 2 of the first line has no name");
  EXPECT_EQ(sentence_of_table("a,b\n\"1,2\n"), "t.csv: line 2: a quote is not closed");
  const auto named = parse_tidy_csv("a,b\n1,x\n", "t.csv");
  EXPECT_EQ(named->number(0, 1).error().message, "t.csv: line 2: column 'b' is 'x'; need a number");
  const auto plain = parse_tidy_csv("1,2\n1,inf\n", "t.csv");
  EXPECT_EQ(plain->number(1, 1).error().message, "t.csv: line 2: column 2 is 'inf'; need a number");
}

TEST(TidyCsv, AFileIsReadAndOneThatIsNotThereIsSaid) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "t.csv", "a,b\n1,2\n", false));
  EXPECT_EQ(read_tidy_csv(scratch / "t.csv")->rows(), 1);
  EXPECT_EQ(read_tidy_csv(scratch / "no.csv").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/table_cell.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "kinemark/core/missing.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {
namespace {

TEST(TableCell, NumbersAreEmptyWhereThereIsNone) {
  EXPECT_EQ(table_cell(1.0 / 3.0), "0.333333333");
  EXPECT_EQ(table_cell(kNaN), "");
  EXPECT_EQ(table_cell(std::numeric_limits<double>::infinity()), "");
  EXPECT_TRUE(json_number(kNaN).is_null());
  EXPECT_EQ(json_number(2.5), 2.5);
}

TEST(TableCell, TextIsQuotedWhereItMustBe) {
  EXPECT_EQ(table_cell(std::string("plain text")), "plain text");
  EXPECT_EQ(table_cell(std::string("a,\"b\"")), "\"a,\"\"b\"\"\"");
  EXPECT_EQ(table_cell(std::string("two\nlines")), "\"two\nlines\"");
}

TEST(TableCell, ANameIsNoFormula) {
  for (const char* name : {"=1+1", "+toe", "-x", "@heel", "'=x", "''@x"})
    EXPECT_EQ(table_cell(std::string(name)), std::string("'") + name);
  EXPECT_EQ(table_cell(std::string("=A1,B1")), "\"'=A1,B1\"");
  for (const char* name : {"-1.5", "+3", "'toe", "a=b", "", "'"})
    EXPECT_EQ(table_cell(std::string(name)), name);
  // What reads our tables gets the names back.
  for (const char* name : {"=1+1", "+toe", "-x", "@heel", "'=x", "''@x", "'toe", "-1.5"}) {
    const auto table = io::parse_tidy_csv("a,b\n" + table_cell(std::string(name)) + ",1\n", "t.csv");
    ASSERT_TRUE(table);
    EXPECT_EQ((*table)(0, 0), name);
  }
}

}  // namespace
}  // namespace kinemark::pipeline

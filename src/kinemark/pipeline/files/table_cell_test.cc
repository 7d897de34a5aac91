// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/table_cell.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "kinemark/core/missing.h"

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

}  // namespace
}  // namespace kinemark::pipeline

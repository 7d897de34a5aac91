// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/pipeline/segments/internal/definition_fields.h"

namespace kinemark::pipeline::internal {
namespace {

using ::testing::HasSubstr;

TEST(DefinitionFields, AxesAreXYZ) {
  EXPECT_EQ(axis_of("x"), 0);
  EXPECT_EQ(axis_of("z"), 2);
  EXPECT_FALSE(axis_of("w"));
  EXPECT_FALSE(axis_of("X"));
  EXPECT_FALSE(axis_of("xy"));
  EXPECT_FALSE(axis_of(""));
}

TEST(DefinitionFields, AxesHaveASignOrNone) {
  EXPECT_EQ(signed_axis_of("y"), std::pair(1, 1.0));
  EXPECT_EQ(signed_axis_of("+y"), std::pair(1, 1.0));
  EXPECT_EQ(signed_axis_of("-z"), std::pair(2, -1.0));
  EXPECT_FALSE(signed_axis_of("--z"));
  EXPECT_FALSE(signed_axis_of("-"));
  EXPECT_FALSE(signed_axis_of(""));
  EXPECT_FALSE(signed_axis_of("1"));
}

TEST(DefinitionFields, FormulaSaysWhereItIsWrong) {
  ASSERT_TRUE(formula_of("mean(A, B)", "d.toml: point 'P'", "formula"));
  const auto wrong = formula_of("mean(A,", "d.toml: point 'P'", "formula");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::bad_input);
  EXPECT_THAT(wrong.error().message, HasSubstr("d.toml: point 'P': formula: "));
}

TEST(DefinitionFields, FormulaOfAKeyMayBeAbsentOrMustBeThere) {
  const auto table = io::parse_toml("mass = \"3 * 2\"\nempty = \"\"\n", "d.toml").value();
  io::TomlFields fields(table, "d.toml");
  std::optional<analysis::Formula> absent, there;
  ASSERT_TRUE(take_formula(fields, "sd", absent));
  EXPECT_FALSE(absent);
  ASSERT_TRUE(take_formula(fields, "mass", there));
  ASSERT_TRUE(there);
  EXPECT_EQ(there->name, "*");
  analysis::Formula needed;
  const auto missing = take_formula(fields, "centre", needed);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("centre"));
}

}  // namespace
}  // namespace kinemark::pipeline::internal

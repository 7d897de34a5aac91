// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rig/toml_fields.h"

#include <gmock/gmock.h>

#include <functional>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Need = TomlFields::Need;

/// What reading a text ends with: "good", or the sentence.
std::string answer(std::string_view text, const std::function<void(TomlFields&)>& read) {
  const auto table = toml::parse(text);
  TomlFields fields(table, "a.toml: lens");
  read(fields);
  const auto status = fields.finish();
  return status ? "good" : status.error().message;
}

TEST(TomlFields, ReadsEveryKindAndLeavesDefaultsWhereThereIsNothing) {
  double number = 1.0, whole = 1.0, absent = 7.0;
  int integer = 0;
  bool flag = false;
  std::string text;
  std::vector<double> numbers{9.0};
  Eigen::Vector2d vector(0.0, 0.0);
  Eigen::Matrix<double, 2, 3> matrix = Eigen::Matrix<double, 2, 3>::Zero();
  EXPECT_EQ(answer(R"(number = -2.5e-3
whole = 3
integer = -7
flag = true
text = "lens \"A\""
numbers = [1, 2.5]
vector = [1, -1]
matrix = [[1, 2, 3], [4, 5, 6.5]]
)",
                   [&](TomlFields& f) {
                     Eigen::MatrixXd m = matrix;
                     Eigen::VectorXd v = vector;
                     f.number("number", number).number("whole", whole).number("absent", absent);
                     f.integer("integer", integer).flag("flag", flag).text("text", text);
                     f.numbers("numbers", numbers).vector("vector", v).matrix("matrix", m);
                     vector = v;
                     matrix = m;
                   }),
            "good");
  EXPECT_EQ(number, -2.5e-3);
  EXPECT_EQ(whole, 3.0) << "a whole number is a number";
  EXPECT_EQ(absent, 7.0);
  EXPECT_EQ(integer, -7);
  EXPECT_TRUE(flag);
  EXPECT_EQ(text, "lens \"A\"");
  EXPECT_THAT(numbers, ElementsAre(1.0, 2.5));
  EXPECT_EQ(vector, Eigen::Vector2d(1.0, -1.0));
  EXPECT_EQ(matrix, (Eigen::Matrix<double, 2, 3>{{1, 2, 3}, {4, 5, 6.5}}));
}

TEST(TomlFields, NumbersAreFinite) {
  for (const char* value : {"nan", "inf", "-inf", "+nan", "true", "\"1\"", "[1]", "1979-05-27"}) {
    const std::string x = std::string("x = ") + value, list = std::string("x = [0, ") + value + "]";
    double number = 5.0;
    EXPECT_EQ(answer(x, [&](TomlFields& f) { f.number("x", number); }),
              "a.toml: lens: x must be a finite number")
        << value;
    EXPECT_EQ(number, 5.0) << "what is refused is not taken";
    std::vector<double> numbers;
    EXPECT_EQ(answer(list, [&](TomlFields& f) { f.numbers("x", numbers); }),
              "a.toml: lens: x must be a list of numbers")
        << value;
    Eigen::VectorXd vector(2);
    EXPECT_EQ(answer(list, [&](TomlFields& f) { f.vector("x", vector); }),
              "a.toml: lens: x must be a list of 2 numbers")
        << value;
    Eigen::MatrixXd matrix(1, 2);
    EXPECT_EQ(answer("x = [[0, " + std::string(value) + "]]", [&](TomlFields& f) { f.matrix("x", matrix); }),
              "a.toml: lens: x must be 1 lists of 2 numbers")
        << value;
  }
}

TEST(TomlFields, IntegersHaveNoFractionAndAnEnd) {
  for (const char* good : {"1000000", "-1000000", "0", "0x10"}) {
    int out = 3;
    EXPECT_EQ(answer(std::string("n = ") + good, [&](TomlFields& f) { f.integer("n", out); }), "good")
        << good;
  }
  for (const char* wrong : {"1000001", "-1000001", "9223372036854775807", "1.0", "1e2", "true", "\"1\""}) {
    int out = 3;
    EXPECT_EQ(answer(std::string("n = ") + wrong, [&](TomlFields& f) { f.integer("n", out); }),
              "a.toml: lens: n must be an integer of at most a million")
        << wrong;
    EXPECT_EQ(out, 3);
  }
}

TEST(TomlFields, ShapesAreExact) {
  for (const char* wrong : {"x = [1, 2]", "x = [1, 2, 3, 4]", "x = []", "x = 3", "x = [[1, 2, 3]]"}) {
    Eigen::VectorXd out(3);
    EXPECT_THAT(answer(wrong, [&](TomlFields& f) { f.vector("x", out); }), HasSubstr("a list of 3 numbers"))
        << wrong;
  }
  for (const char* wrong : {"x = [[1, 2]]", "x = [[1, 2], [3]]", "x = [[1, 2], [3, 4], [5, 6]]", "x = [1, 2]",
                            "x = 1", "x = []"}) {
    Eigen::MatrixXd out(2, 2);
    EXPECT_THAT(answer(wrong, [&](TomlFields& f) { f.matrix("x", out); }), HasSubstr("2 lists of 2 numbers"))
        << wrong;
  }
}

TEST(TomlFields, WhatIsRequiredAndAbsentIsNamedWithWhatItShouldBe) {
  double number = 0.0;
  int integer = 0;
  std::string text;
  Eigen::VectorXd vector(4);
  Eigen::MatrixXd matrix(3, 3);
  const auto missing = [](const std::function<void(TomlFields&)>& read) { return answer("", read); };
  EXPECT_EQ(missing([&](TomlFields& f) { f.number("x", number, Need::required); }),
            "a.toml: lens: x is missing; need a finite number");
  EXPECT_EQ(missing([&](TomlFields& f) { f.integer("x", integer, Need::required); }),
            "a.toml: lens: x is missing; need an integer of at most a million");
  EXPECT_EQ(missing([&](TomlFields& f) { f.text("x", text, Need::required); }),
            "a.toml: lens: x is missing; need text in quotes");
  EXPECT_EQ(missing([&](TomlFields& f) { f.vector("x", vector, Need::required); }),
            "a.toml: lens: x is missing; need a list of 4 numbers");
  EXPECT_EQ(missing([&](TomlFields& f) { f.matrix("x", matrix, Need::required); }),
            "a.toml: lens: x is missing; need 3 lists of 3 numbers");
}

TEST(TomlFields, TheFirstFailureIsTheOneReported) {
  double a = 0.0, b = 0.0;
  int c = 0;
  EXPECT_EQ(answer("a = \"x\"\nb = \"y\"\nstray = 1",
                   [&](TomlFields& f) {
                     f.number("a", a).number("b", b).integer("c", c, Need::required);
                     EXPECT_TRUE(f.failed());
                   }),
            "a.toml: lens: a must be a finite number");
}

TEST(TomlFields, AKeyThatNobodyAskedForIsAFailure) {
  double a = 0.0;
  const auto read = [&](TomlFields& f) { f.number("a", a); };
  EXPECT_EQ(answer("a = 1\nA = 2", read), "a.toml: lens: unknown key 'A'");
  EXPECT_EQ(answer("a = 1\n[b]\nc = 2", read), "a.toml: lens: unknown key 'b'");
  EXPECT_EQ(answer("\"" + std::string(1000, 'k') + "\" = 1", read),
            "a.toml: lens: unknown key '" + std::string(60, 'k') + "'")
      << "long keys are cut";
}

TEST(TomlFields, TablesAndListsOfTables) {
  const auto text = toml::parse("[one]\nx = 1\n[[many]]\nx = 1\n[[many]]\nx = 2\n");
  TomlFields fields(text, "t");
  ASSERT_NE(fields.table("one"), nullptr);
  ASSERT_NE(fields.tables("many"), nullptr);
  EXPECT_EQ(fields.tables("many")->size(), 2U);
  EXPECT_EQ(fields.table("none"), nullptr);
  EXPECT_EQ(fields.tables("none"), nullptr);
  EXPECT_TRUE(fields.finish());
  EXPECT_EQ(answer("x = 1", [](TomlFields& f) { EXPECT_EQ(f.table("x"), nullptr); }),
            "a.toml: lens: x must be a table");
  for (const char* wrong : {"x = 1", "x = [1, 2]", "[x]\ny = 1", "x = [{}, 1]"})
    EXPECT_EQ(answer(wrong, [](TomlFields& f) { EXPECT_EQ(f.tables("x"), nullptr); }),
              "a.toml: lens: x must be a list of tables, [[x]]")
        << wrong;
}

}  // namespace
}  // namespace kinemark::io

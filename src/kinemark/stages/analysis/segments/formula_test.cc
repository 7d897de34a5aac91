// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;

std::string written(const Formula& f) {
  switch (f.kind) {
    case Formula::Kind::number:
      return std::to_string(static_cast<int>(f.value));
    case Formula::Kind::name:
      return f.name + (f.part.empty() ? "" : "." + f.part);
    case Formula::Kind::call:
      break;
  }
  std::string out = f.name + "(";
  for (std::size_t i = 0; i < f.arguments.size(); ++i) out += (i > 0 ? " " : "") + written(f.arguments[i]);
  return out + ")";
}

TEST(Formula, KeepsTheOrderOfOperators) {
  for (const auto& [text, tree] : std::vector<std::pair<std::string, std::string>>{
           {"1 - 2 - 3", "-(-(1 2) 3)"},
           {"1 + 2 * -x", "+(1 *(2 neg(x)))"},
           {"+a / (b - c)", "/(a -(b c))"},
           {"mean(LASI, RASI, 'L.Knee Lat')", "mean(LASI RASI L.Knee Lat)"},
           {" f ( pelvis.x , g() ) ", "f(pelvis.x g())"}}) {
    const auto parsed = parse_formula(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(written(*parsed), tree);
  }
  EXPECT_DOUBLE_EQ(parse_formula("1.5e-3")->value, 1.5e-3);
}

TEST(Formula, SaysWhereItIsWrong) {
  for (const auto& [text, words] :
       std::vector<std::pair<std::string, std::string>>{{"", "it ends; expected a number"},
                                                        {"a +", "column 4"},
                                                        {"(a", "expected ')'"},
                                                        {"a b", "column 3 of 'a b': 'b'"},
                                                        {"f(a", "expected ',' or ')'"},
                                                        {"pelvis.w", "x, y, z or o"},
                                                        {"'a", "a name between quotes"},
                                                        {"1e999", "a number"},
                                                        {"a ; b", "';'"}}) {
    const auto parsed = parse_formula(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().code, Code::bad_input);
    EXPECT_THAT(parsed.error().message, HasSubstr(words)) << text;
  }
}

TEST(Formula, RefusesWhatIsNestedWithoutEnd) {
  const std::string deep = std::string(900, '(') + "1" + std::string(900, ')');
  EXPECT_THAT(parse_formula(deep).error().message, HasSubstr("64 levels"));
  EXPECT_THAT(parse_formula(std::string(1900, '-') + "1").error().message, HasSubstr("64 levels"));
  EXPECT_THAT(parse_formula(std::string(100'000, '(')).error().message, HasSubstr("2000 at most"));
  EXPECT_TRUE(parse_formula(std::string(60, '(') + "1" + std::string(60, ')')));
}

}  // namespace
}  // namespace kinemark::analysis

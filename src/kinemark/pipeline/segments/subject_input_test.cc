// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/subject_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "kinemark/workflow/segments/testing/subject_measures.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using workflow::subject_measures;

TEST(SubjectInput, AreTypedInTheUnitsOfTheField) {
  const auto leg = parse_subject_value("LeftLegLength=920", subject_measures());
  ASSERT_TRUE(leg);
  EXPECT_EQ(leg->name, "LLegLength");
  EXPECT_DOUBLE_EQ(leg->value, 0.92);
  EXPECT_DOUBLE_EQ(parse_subject_value("LThighRotation=-90", subject_measures())->value,
                   -0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_subject_value("Bodymass=74.5", subject_measures())->value, 74.5);
}

TEST(SubjectInput, CarryTheirDeviation) {
  const auto turn = parse_subject_value("LThighRotation=-4+-2.5", subject_measures());
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->value, -4.0 * std::numbers::pi / 180.0, 1e-12);
  ASSERT_TRUE(turn->sd);
  EXPECT_NEAR(*turn->sd, 2.5 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_FALSE(parse_subject_value("LThighRotation=-4", subject_measures())->sd);
  EXPECT_EQ(*parse_subject_value("LLegLength=920+-0", subject_measures())->sd, 0.0);
}

TEST(SubjectInput, OfAnotherFormAreRefused) {
  for (const char* text : {"LLegLength", "=3", "LLegLength=", "LLegLength=long", "LLegLength=nan",
                           "LLegLength=920+-", "LLegLength=920+--3", "LLegLength=920+-x", "LLegLength=+-3"})
    EXPECT_THAT(parse_subject_value(text, subject_measures()).error().message, HasSubstr("is not NAME=VALUE"))
        << text;
  const auto unknown = parse_subject_value("LLegLenght=920", subject_measures());
  EXPECT_EQ(unknown.error().code, Code::usage);
  EXPECT_THAT(unknown.error().message, HasSubstr("no parameter 'LLegLenght'; it has LLegLength"));
}

TEST(SubjectInput, AreReadFromAVsk) {
  io::Vsk vsk;
  vsk.parameters = {{"LeftLegLength", "m", 0.94, ""}, {"LeftAsis", "m", std::nullopt, "2 * 3"}};
  const auto values = subject_values(vsk, "Ann.vsk");
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values[0].name, "LeftLegLength");
  EXPECT_EQ(values[0].from, "Ann.vsk");
}

TEST(SubjectInput, AreReadFromAParameterFile) {
  const auto values =
      parse_mp("!MKR\n$LLegLength = 920\r\n$LThighRotation=0.1\n$Other = 3\n", "Ann.mp", subject_measures());
  ASSERT_TRUE(values);
  ASSERT_EQ(values->size(), 2U);
  EXPECT_NEAR((*values)[0].value, 0.92, 1e-12);
  EXPECT_EQ((*values)[1].value, 0.1);
  EXPECT_EQ((*values)[1].from, "Ann.mp");
  EXPECT_THAT(parse_mp("no parameters", "Ann.mp", subject_measures()).error().message,
              HasSubstr("Ann.mp: no line '$NAME = VALUE'"));
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/subject_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <numbers>

#include "kinemark/workflow/segments/testing/subject_measures.h"

namespace kinemark::workflow {
namespace {

using analysis::SubjectQuantity;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

data::ForeignParameter number(const std::string& name, float value) {
  data::ForeignParameter out{.name = name, .type = 4, .dims = {1}};
  for (std::size_t k = 0; k < 4; ++k)
    out.values.push_back(static_cast<std::byte>(std::bit_cast<std::uint32_t>(value) >> (8 * k) & 0xFF));
  return out;
}

TEST(SubjectValues, AreReadFromAC3dFilesProcessing) {
  data::Trial trial;
  trial.source = "walk.c3d";
  trial.units_in_file = "mm";
  auto text = number("LThighRotation", 0.0F);
  text.type = -1;
  trial.foreign = {{.name = "OTHER", .parameters = {number("LLegLength", 1.0F)}},
                   {.name = "PROCESSING",
                    .parameters = {number("LeftLegLength", 920.0F), number("Unknown", 3.0F), text,
                                   number("LThighRotation", 0.25F)}}};
  const auto values = subject_values(trial, subject_measures());
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[0].name, "LLegLength");
  EXPECT_NEAR(values[0].value, 0.92, 1e-12);
  EXPECT_EQ(values[0].from, "walk.c3d");
  EXPECT_DOUBLE_EQ(values[1].value, 0.25);
  trial.foreign[1].parameters[0].values.pop_back();
  EXPECT_EQ(subject_values(trial, subject_measures()).size(), 1U);
}

TEST(SubjectValues, AreReadFromWholeNumbersOfAC3dFileToo) {
  data::Trial trial;
  trial.units_in_file = "mm";
  data::ForeignParameter leg{.name = "LLegLength", .type = 2, .dims = {1}};
  leg.values = {std::byte{0x98}, std::byte{0x03}};  // 920
  trial.foreign = {{.name = "PROCESSING", .parameters = {leg}}};
  const auto values = subject_values(trial, subject_measures());
  ASSERT_EQ(values.size(), 1U);
  EXPECT_NEAR(values[0].value, 0.92, 1e-12);
}

TEST(SubjectValues, AMarkerSetWithADeviceMeasuresOffsets) {
  data::Trial trial;
  trial.markers.names = {"Ann:LKNE", "Ann:LTHI"};
  EXPECT_FALSE(measures_offsets(trial));
  trial.markers.names.emplace_back("Ann:LKAX");
  EXPECT_TRUE(measures_offsets(trial)) << "a knee alignment device";
  trial.markers.names.pop_back();
  data::ForeignParameter set{.name = "MARKER_SETS", .type = -1, .dims = {3}};
  for (const char letter : {'K', 'a', 'd'}) set.values.push_back(static_cast<std::byte>(letter));
  trial.foreign = {{.name = "SUBJECTS", .parameters = {set}}};
  EXPECT_TRUE(measures_offsets(trial)) << "its name says so";
  trial.foreign[0].name = "OTHER";
  EXPECT_FALSE(measures_offsets(trial));
}

TEST(SubjectValues, MendedUnitsAreSaidAndRightOnesAreNot) {
  const auto notes = [](double leg, double turn) {
    std::vector<analysis::SubjectValue> values{{"LLegLength", leg, "a.c3d"},
                                               {"LThighRotation", turn, "a.c3d"}};
    std::vector<std::string> out;
    mend_units(values, subject_measures(), out);
    return out;
  };
  EXPECT_THAT(notes(0.92, 12.0),
              Contains("a.c3d: its angles are taken as degrees: 12 rad is no offset of a marker"));
  EXPECT_THAT(notes(0.92, 12.0), Not(Contains(HasSubstr(": its lengths are taken times"))));
  EXPECT_THAT(notes(920.0, 0.2), Contains("a.c3d: its lengths are taken times 0.001: no leg is 920 m long"));
  EXPECT_THAT(notes(920.0, 0.2), Not(Contains(HasSubstr(": its angles are taken as degrees:"))));
  EXPECT_EQ(notes(920.0, 12.0).size(), 2U);
  EXPECT_TRUE(notes(0.92, 0.2).empty());
}

TEST(SubjectValues, LengthsThatNoFactorMendsStayAsTheyAre) {
  std::vector<analysis::SubjectValue> values{{"LLegLength", 3.0e-7, "a.c3d"}};
  std::vector<std::string> notes;
  mend_units(values, subject_measures(), notes);
  EXPECT_EQ(values[0].value, 3.0e-7);
  EXPECT_TRUE(notes.empty());
}

TEST(SubjectValues, HaveTheUnitsThatAreShown) {
  EXPECT_EQ(shown_unit(SubjectQuantity::length), "mm");
  EXPECT_EQ(shown_unit(SubjectQuantity::angle), "deg");
  EXPECT_EQ(shown_unit(SubjectQuantity::mass), "kg");
  EXPECT_EQ(shown_unit(SubjectQuantity::number), "");
  EXPECT_DOUBLE_EQ(0.92 / per_shown(SubjectQuantity::length), 920.0);
  EXPECT_NEAR(std::numbers::pi / per_shown(SubjectQuantity::angle), 180.0, 1e-12);
  EXPECT_EQ(per_shown(SubjectQuantity::mass), 1.0);
}

TEST(SubjectValues, AreMendedWhereNoBodyHasThem) {
  const auto mended = [](double leg, double turn, std::size_t notes) {
    std::vector<analysis::SubjectValue> values{{"LLegLength", leg, "a.c3d"},
                                               {"LThighRotation", turn, "a.c3d"}};
    std::vector<std::string> warnings;
    mend_units(values, subject_measures(), warnings);
    EXPECT_EQ(warnings.size(), notes);
    return std::pair(values[0].value, values[1].value);
  };
  EXPECT_EQ(mended(0.92, 0.48, 0), std::pair(0.92, 0.48)) << "nothing is wrong";
  EXPECT_NEAR(mended(920.0, 0.1, 1).first, 0.92, 1e-12) << "mm in a file in m";
  EXPECT_NEAR(mended(0.00092, 0.1, 1).first, 0.92, 1e-12) << "m in a file in mm";
  EXPECT_NEAR(mended(0.92, 12.0, 1).second, 12.0 * std::numbers::pi / 180.0, 1e-12) << "degrees";
  EXPECT_EQ(mended(0.0, 0.0, 0).first, 0.0);
}

}  // namespace
}  // namespace kinemark::workflow

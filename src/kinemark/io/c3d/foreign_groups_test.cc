// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/foreign_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::ForeignGroup;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::ScratchFolder;

std::vector<std::byte> bytes_of_words(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int v : values) out.push_back(static_cast<std::byte>(v));
  return out;
}

/// Lower case, blanks, a byte that is no UTF-8, locks, all types and an empty array.
ForeignGroup processing() {
  return {.name = "Processing",
          .locked = true,
          .description =
              " Gr\xF6\xDF"
              "e ",
          .parameters = {
              {.name = "LLegLength",
               .locked = true,
               .type = 4,
               .dims = {},
               .values = bytes_of_words({0, 0, 0x20, 0x41}),
               .description = "mm "},
              {.name = "COUNTS", .type = 2, .dims = {2}, .values = bytes_of_words({1, 2, 0xFE, 0xFF})},
              {.name = "FLAGS", .type = 1, .dims = {3}, .values = bytes_of_words({0, 200, 255})},
              {.name = "NAMES", .type = -1, .dims = {2, 2}, .values = bytes_of_words({'a', ' ', 0xF6, 0})},
              {.name = "EMPTY", .type = -1, .dims = {8, 0}}}};
}

void expect_same(const ForeignGroup& a, const ForeignGroup& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.locked, b.locked);
  EXPECT_EQ(a.description, b.description);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    SCOPED_TRACE(a.parameters[i].name);
    EXPECT_EQ(a.parameters[i].name, b.parameters[i].name);
    EXPECT_EQ(a.parameters[i].locked, b.parameters[i].locked);
    EXPECT_EQ(a.parameters[i].type, b.parameters[i].type);
    EXPECT_EQ(a.parameters[i].dims, b.parameters[i].dims);
    EXPECT_EQ(a.parameters[i].values, b.parameters[i].values);
    EXPECT_EQ(a.parameters[i].description, b.parameters[i].description);
  }
}

class ForeignGroupsOf : public testing::TestWithParam<Processor> {};

TEST_P(ForeignGroupsOf, ComeBackByteForByte) {
  const ScratchFolder folder;
  data::Trial trial = internal::simulate_trial({});
  trial.foreign = {processing(), {.name = "SUBJECTS"}};
  const auto path = folder.path() / "a.c3d";
  ASSERT_TRUE(write_c3d(path, trial, {.processor = GetParam()}));
  const auto back = read_c3d(path);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->foreign.size(), 2U);
  expect_same(back->foreign[0], trial.foreign[0]);
  expect_same(back->foreign[1], trial.foreign[1]);
}

INSTANTIATE_TEST_SUITE_P(Processors, ForeignGroupsOf,
                         testing::Values(Processor::intel, Processor::dec, Processor::mips));

C3dParameters groups(std::initializer_list<const char*> names) {
  C3dParameters out;
  for (const char* name : names) out.group(name).stored.name = name;
  return out;
}

std::vector<std::string> names_of(const std::vector<ForeignGroup>& found) {
  std::vector<std::string> out;
  for (const ForeignGroup& g : found) out.push_back(g.name);
  return out;
}

TEST(ForeignGroups, LeaveOutWhatTheTrialHoldsAndWhatHasNoName) {
  std::vector<std::string> warnings;
  C3dParameters p = groups({"POINT", "SUBJECTS", "ANALOG", "EVENT", "EVENT_CONTEXT", "ROTATION", "KINEMARK"});
  p.group("GROUP 9");
  EXPECT_THAT(names_of(find_foreign_groups(p, warnings)), ElementsAre("SUBJECTS", "EVENT_CONTEXT"));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(ForeignGroups, AreBoundedAndTheRestIsSaid) {
  std::vector<std::string> warnings;
  C3dParameters p = groups({"SMALL", "LARGE", "LAST"});
  p.group("LARGE").parameters.push_back(
      {.name = "X",
       .stored = {.name = "X", .type = 1, .dims = {255, 255}, .values = std::vector<std::byte>(65025)}});
  EXPECT_THAT(names_of(find_foreign_groups(p, warnings)), ElementsAre("SMALL", "LAST"));
  EXPECT_THAT(warnings,
              ElementsAre(HasSubstr("1 group of parameters that kinemark does not read is too large")));

  warnings.clear();
  C3dParameters many;
  for (int i = 0; i < 127; ++i) many.group("G" + std::to_string(i)).stored.name = "G";
  EXPECT_EQ(find_foreign_groups(many, warnings).size(), 120U);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("7 groups of parameters")));
}

C3dParameter stored(const char* name) {
  return {.name = name, .stored = {.name = name, .type = 1, .dims = {}, .values = std::vector<std::byte>(1)}};
}

TEST(ForeignGroups, WhoRecordedATrialStaysAndACopyOfOursNamesUsOnce) {
  const ScratchFolder folder;
  data::Trial trial = internal::simulate_trial({});
  ASSERT_TRUE(write_c3d(folder / "ours.c3d", trial, {}));
  const auto ours = read_c3d(folder / "ours.c3d").value();
  EXPECT_EQ(ours.software, "kinemark");
  EXPECT_THAT(ours.foreign, IsEmpty());

  trial.foreign = {
      {.name = "Manufacturer",
       .parameters = {
           {.name = "Company", .type = -1, .dims = {5}, .values = bytes_of_words({'V', 'i', 'c', 'o', 'n'})},
           {.name = "SOFTWARE",
            .type = -1,
            .dims = {5},
            .values = bytes_of_words({'N', 'e', 'x', 'u', 's'})}}}};
  ASSERT_TRUE(write_c3d(folder / "a.c3d", trial, {}));
  const auto copy = read_c3d(folder / "a.c3d").value();
  EXPECT_EQ(copy.software, "Vicon Nexus");
  ASSERT_EQ(copy.foreign.size(), 1U);
  expect_same(copy.foreign[0], trial.foreign[0]);
}

TEST(ForeignGroups, OfGroupsThatAreWrittenAnewTheRestIsCarried) {
  std::vector<std::string> warnings;
  C3dParameters p = groups({"POINT", "ANALOG", "TRIAL", "MANUFACTURER"});
  for (const char* name : {"USED", "LABELS", "LABELS2", "X_SCREEN", "ANGLES", "KNEES", "MOVIE_ID"})
    p.group("POINT").parameters.push_back(stored(name));
  p.group("POINT").parameters.push_back({.name = "TYPE_GROUPS",
                                         .type = C3dType::text,
                                         .dims = {5, 2, 1},
                                         .texts = {"KNEES", "KNEE"},
                                         .stored = {.name = "TYPE_GROUPS"}});
  for (const char* name : {"GAIN", "OFFSETS", "BOARDS"}) p.group("ANALOG").parameters.push_back(stored(name));
  p.group("TRIAL").parameters.push_back(stored("ACTUAL_START_FIELD"));
  p.group("MANUFACTURER").parameters.push_back(stored("COMPANY"));
  const auto found = find_foreign_groups(p, warnings);
  ASSERT_THAT(names_of(found), ElementsAre("POINT", "ANALOG", "MANUFACTURER"));
  ASSERT_EQ(found[0].parameters.size(), 2U);
  EXPECT_EQ(found[0].parameters[0].name, "X_SCREEN");
  EXPECT_EQ(found[0].parameters[1].name, "MOVIE_ID");
  ASSERT_EQ(found[1].parameters.size(), 1U);
  EXPECT_EQ(found[1].parameters[0].name, "BOARDS");
}

TEST(ForeignGroups, UnitsOfChannelsAreTheTrialsWhereThereAreAny) {
  std::vector<std::string> warnings;
  C3dParameters p = groups({"POINT"});
  for (const char* name : {"ANGLE_UNITS", "POWER_UNITS", "ODD_UNITS"})
    p.group("POINT").parameters.push_back(stored(name));
  p.group("POINT").parameters.push_back({.name = "ANGLES",
                                         .type = C3dType::text,
                                         .dims = {5, 1},
                                         .texts = {"LKnee"},
                                         .stored = {.name = "ANGLES"}});
  const auto found = find_foreign_groups(p, warnings);
  ASSERT_THAT(names_of(found), ElementsAre("POINT"));
  ASSERT_EQ(found[0].parameters.size(), 2U);
  EXPECT_EQ(found[0].parameters[0].name, "POWER_UNITS");
  EXPECT_EQ(found[0].parameters[1].name, "ODD_UNITS");
}

TEST(ForeignGroups, TheRestOfAWrittenGroupStandsInItOnce) {
  const ScratchFolder folder;
  data::Trial trial = internal::simulate_trial({});
  const data::ForeignParameter screen{
      .name = "X_screen", .type = -1, .dims = {2}, .values = bytes_of_words({'+', 'X'})},
      rate{.name = "RATE", .type = 2, .dims = {}, .values = bytes_of_words({7, 0})};
  trial.foreign = {{.name = "Point", .parameters = {screen, rate}}};
  const auto path = folder.path() / "a.c3d";
  ASSERT_TRUE(write_c3d(path, trial));
  const auto reader = C3dReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_EQ(std::ranges::count(reader->parameters().groups, "POINT", &C3dGroup::name), 1);
  EXPECT_EQ(reader->parameters().text("POINT", "X_SCREEN"), "+X");
  EXPECT_FLOAT_EQ(static_cast<float>(reader->parameters().number("POINT", "RATE").value()),
                  static_cast<float>(trial.markers.time.rate_hz))
      << "what is written wins";
  const auto back = read_c3d(path);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->foreign.size(), 1U);
  EXPECT_EQ(back->foreign[0].name, "POINT");
  ASSERT_EQ(back->foreign[0].parameters.size(), 1U);
  EXPECT_EQ(back->foreign[0].parameters[0].values, screen.values);
}

TEST(ForeignGroups, GiveWayWhereTheSectionIsFullAndThatIsSaid) {
  const ScratchFolder folder;
  data::Trial trial = internal::simulate_trial({});
  for (int i = 0; i < 6; ++i)
    trial.foreign.push_back(
        {.name = "BIG" + std::to_string(i),
         .parameters = {
             {.name = "X", .type = 1, .dims = {255, 100}, .values = std::vector<std::byte>(25500)}}});
  std::vector<std::string> lost;
  const auto path = folder.path() / "a.c3d";
  ASSERT_TRUE(write_c3d(path, trial, {.lost = &lost}));
  EXPECT_THAT(lost, ElementsAre(HasSubstr("6 groups of parameters that kinemark does not read had no room")));
  const auto back = read_c3d(path);
  ASSERT_TRUE(back);
  EXPECT_THAT(back->foreign, IsEmpty());
  EXPECT_EQ(back->markers.names, trial.markers.names);
  trial.foreign.resize(1);
  lost.clear();
  ASSERT_TRUE(write_c3d(folder.path() / "b.c3d", trial, {.lost = &lost}));
  EXPECT_THAT(lost, IsEmpty());
}

TEST(ForeignGroups, CutShortParametersAreNotCarried) {
  std::vector<std::string> warnings;
  C3dParameters p = groups({"SEG"});
  p.group("SEG").parameters.push_back({.name = "HALF"});
  const auto found = find_foreign_groups(p, warnings);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].parameters, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io

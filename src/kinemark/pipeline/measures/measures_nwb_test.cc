// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_nwb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

data::Measure measure(const std::string& id, const std::string& subject, double value) {
  data::Measure out{.id = id, .subject = subject, .start_s = 0.5, .end_s = 1.5, .value = value, .sd = 0.001};
  out.interval = {.kind = data::IntervalKind::at_most, .high = value + 0.002};
  return out;
}

std::vector<NamedMeasures> recordings() {
  auto late = measure("path_length", "RFIN", 0.5);
  late.cycle = 1, late.start_s = 0.2, late.share_not_measured = 0.25;
  return {
      {.name =
           {.file = "a.c3d", .participant = "sub-1", .trial = "a", .more = {{"age", "34"}, {"group", "old"}}},
       .measures = {measure("path_length", "RFIN", 0.3), measure("plane_sd", "RFIN", 0.01), late}},
      {.name = {.file = "b.c3d", .participant = "sub-2", .trial = "b", .more = {{"age", ""}, {"group", ""}}},
       .measures = {measure("plane_sd", "RFIN", 0.02), measure("plane_sd", "RFIN", 0.03)}}};
}

const io::NwbColumn& find(const io::NwbTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name, &io::NwbColumn::name);
  if (found == table.columns.end()) throw std::runtime_error("no column " + name);
  return *found;
}

TEST(MeasureTables, OneRowHoldsAllMeasuresOfASubjectAndStretch) {
  const auto tables = measure_tables(recordings());
  ASSERT_THAT(tables, SizeIs(3));
  const auto& wide = tables[0];
  EXPECT_THAT(find(wide, "file").texts, ElementsAre("a.c3d", "a.c3d", "b.c3d", "b.c3d"));
  EXPECT_THAT(find(wide, "participant").texts, ElementsAre("sub-1", "sub-1", "sub-2", "sub-2"));
  EXPECT_THAT(find(wide, "plane_sd").numbers, ElementsAre(10.0, ::testing::IsNan(), 20.0, 30.0));
  EXPECT_THAT(find(wide, "path_length").numbers,
              ElementsAre(300.0, 500.0, ::testing::IsNan(), ::testing::IsNan()));
  EXPECT_NEAR(find(wide, "path_length_high").numbers[0], 302.0, 1e-9);
  EXPECT_TRUE(std::isnan(find(wide, "path_length_low").numbers[0]));
  EXPECT_THAT(find(wide, "share_not_measured").numbers, ElementsAre(0.0, 0.25, 0.0, 0.0));
  EXPECT_THAT(find(wide, "age").numbers, ElementsAre(34.0, 34.0, ::testing::IsNan(), ::testing::IsNan()));
  EXPECT_THAT(find(wide, "group").texts, ElementsAre("old", "old", "", ""));
}

TEST(MeasureTables, AColumnSaysWhatItsMeasureIs) {
  const auto tables = measure_tables(recordings());
  EXPECT_EQ(find(tables[0], "path_length").description,
            "Path length, mm: sum of |x[i+1] - x[i]| (definition)");
  EXPECT_THAT(find(tables[0], "plane_sd_low").description,
              HasSubstr("lower end of the interval of SD from the best-fit plane, mm"));
  EXPECT_THAT(find(tables[2], "measure").texts, ElementsAre("path_length", "plane_sd"));
  EXPECT_THAT(find(tables[2], "unit").texts, ElementsAre("mm", "mm"));
  EXPECT_THAT(find(tables[2], "source").texts[1], HasSubstr("Poizner"));
}

TEST(MeasureTables, ColumnsOfEveryMeasureHaveNamesOfTheirOwn) {
  NamedMeasures all{.name = {.file = "a.c3d"}, .measures = {}};
  for (const auto& one : measure_list_json())
    all.measures.push_back(measure(one["measure"].get<std::string>(), "RFIN", 1.0));
  for (const auto& table : measure_tables({all})) {
    std::set<std::string> names;
    for (const auto& column : table.columns) EXPECT_TRUE(names.insert(column.name).second) << column.name;
  }
  EXPECT_EQ(measure_tables({all})[2].columns[0].texts.size(), all.measures.size());
}

TEST(MeasureTables, EventsStandBesideThemWithTheirDeviations) {
  auto measured = recordings();
  measured[1].events = {
      {.context = "Left", .label = "Foot Strike", .time_s = 1.25, .frame = 126, .sd_s = 0.004},
      {.context = "Left", .label = "Foot Off", .time_s = 1.9, .frame = 191}};
  const auto tables = measure_tables(measured);
  ASSERT_THAT(tables, SizeIs(4));
  EXPECT_EQ(tables[3].name, "movement_events");
  EXPECT_THAT(find(tables[3], "file").texts, ElementsAre("b.c3d", "b.c3d"));
  EXPECT_THAT(find(tables[3], "time_s").numbers, ElementsAre(1.25, 1.9));
  EXPECT_THAT(find(tables[3], "sd_s").numbers, ElementsAre(0.004, ::testing::IsNan()));
}

TEST(MeasureTables, TheTidyOneLosesNothing) {
  const auto tidy = measure_tables(recordings())[1];
  EXPECT_THAT(find(tidy, "measure").texts,
              ElementsAre("path_length", "plane_sd", "path_length", "plane_sd", "plane_sd"));
  EXPECT_THAT(find(tidy, "value").numbers, ElementsAre(300.0, 10.0, 500.0, 20.0, 30.0));
  EXPECT_THAT(find(tidy, "cycle").numbers, ElementsAre(::testing::IsNan(), ::testing::IsNan(), 1.0,
                                                       ::testing::IsNan(), ::testing::IsNan()));
  EXPECT_EQ(find(tidy, "interval").texts[0], "at most");
  for (const auto& table : measure_tables(recordings()))
    for (const auto& column : table.columns) EXPECT_FALSE(column.description.empty()) << column.name;
  EXPECT_TRUE(measure_tables({}).empty());
}

}  // namespace
}  // namespace kinemark::pipeline

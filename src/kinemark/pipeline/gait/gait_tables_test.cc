// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::known_curve;
using ::testing::Not;

GaitSheet sheet_with(const GaitNorms& norms = {}) {
  return make_gait_sheet(
      "walk",
      {known_curve("LKneeAngles x", Side::left, 3, 0.5), known_curve("LHipAngles x", Side::left, 3, 0.5)},
      testing::known_gait(3, 0), norms);
}

TEST(GaitTables, CurvesAreWhatIsDrawn) {
  const auto sheet = sheet_with({.curves = {testing::known_norm("KneeAngles x")}});
  const auto table = io::parse_tidy_csv(sheet_csv(sheet), "curves");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->rows(), 2 * 4 * 101);
  std::int64_t seen = 0;
  for (std::int64_t r = 0; r < table->rows(); ++r) {
    const auto cell = [&](const char* column) { return (*table)(r, table->find(column)); };
    if (cell("quantity") != "knee_flexion" || cell("percent") != "30") continue;
    ++seen;
    EXPECT_EQ(cell("context"), "Left");
    EXPECT_EQ(cell("curve"), "LKneeAngles x");
    EXPECT_EQ(cell("unit"), "deg");
    const auto value = table->number(r, table->find("value")).value();
    if (cell("cycle") == "mean") {
      EXPECT_NEAR(value, testing::known_angle_deg(1, 3, 0.3), 1e-6);
      EXPECT_NEAR(table->number(r, table->find("sd")).value(), 2.0, 1e-6);
      EXPECT_EQ(cell("own_sd"), "0.5");
      EXPECT_EQ(cell("cycles"), "3");
      EXPECT_EQ(cell("norm_low"), "10");
      EXPECT_EQ(cell("norm_high"), "30");
      EXPECT_EQ(cell("norm_mean"), "20");
    } else {
      EXPECT_NEAR(value, testing::known_angle_deg(std::stoi(cell("cycle")) - 1, 3, 0.3), 1e-6);
      EXPECT_EQ(cell("own_sd"), "0.5");
      EXPECT_TRUE(cell("sd").empty());
      EXPECT_TRUE(cell("norm_low").empty());
    }
  }
  EXPECT_EQ(seen, 4);
}

TEST(GaitTables, ACurveWithoutNormOrErrorLeavesTheirCellsBlank) {
  const auto sheet =
      make_gait_sheet("w", {known_curve("LKneeAngles x", Side::left, 1)}, testing::known_gait(1, 0), {});
  const auto table = io::parse_tidy_csv(sheet_csv(sheet), "curves");
  ASSERT_TRUE(table) << table.error().message;
  for (const auto* column : {"sd", "own_sd", "norm_low", "norm_mean"})
    EXPECT_TRUE((*table)(150, table->find(column)).empty()) << column;
}

TEST(GaitTables, PairsAreWhatIsDrawn) {
  const auto sheet = sheet_with();
  std::vector<std::string> remarks;
  const auto pairs = angle_pairs(sheet, {}, remarks);
  const auto table = io::parse_tidy_csv(pairs_csv(pairs), "pairs");
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->rows(), 101);
  const auto number = [&](const char* column) { return table->number(60, table->find(column)).value(); };
  EXPECT_EQ((*table)(60, table->find("x")), "hip_flexion");
  EXPECT_NEAR(number("x_mean"), testing::known_angle_deg(1, 3, 0.6), 1e-6);
  EXPECT_NEAR(number("y_sd"), 2.0, 1e-6);
  EXPECT_NEAR(number("correlation"), 1.0, 1e-6);
  EXPECT_EQ(number("cycles"), 3.0);
}

data::Measure measure(const std::string& context, double value, double low, double high) {
  data::Measure out{
      .id = "stride_time", .context = context, .quantity = data::Quantity::time, .value = value};
  out.interval = {.kind = data::IntervalKind::two_sided, .low = low, .high = high};
  return out;
}

std::vector<MeasureRow> rows_of(const std::vector<data::Measure>& measures,
                                const std::vector<NormMeasure>& norms = {}) {
  GaitSheet sheet;
  sheet.measures = measures;
  sheet.norms = norms;
  return measure_rows(sheet);
}

TEST(GaitTables, MeasuresOfBothSidesShareARow) {
  const auto rows = rows_of({measure("Left", 1.0, 0.99, 1.01), measure("Right", 1.1, 1.05, 1.15)});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].title, "Stride time");
  EXPECT_EQ(rows[0].unit, "s");
  EXPECT_THAT(rows[0].value, ElementsAre("1 [0.99 to 1.01]", "1.1 [1.05 to 1.15]", ""));
  EXPECT_TRUE(rows[0].norm.empty());
}

TEST(GaitTables, ValuesAreJudgedWithTheirIntervals) {
  const NormMeasure norm{.id = "stride_time", .unit = "s", .low = 1.0, .high = 1.2};
  const auto judged = [&](double value, double low, double high) {
    return rows_of({measure("Left", value, low, high)}, {norm})[0].judgement[0];
  };
  EXPECT_EQ(judged(1.1, 1.05, 1.15), "within");
  EXPECT_EQ(judged(0.9, 0.85, 0.95), "below");
  EXPECT_EQ(judged(1.3, 1.25, 1.35), "above");
  for (const double sure : {0.9, 1.3})
    EXPECT_THAT(judged(sure, sure - 0.05, sure + 0.05), Not(HasSubstr("but its interval reaches the norm")));
  EXPECT_THAT(judged(1.1, 1.0, 1.2), Not(HasSubstr("but its interval reaches beyond"))) << "to its very ends";
  EXPECT_EQ(judged(0.95, 0.85, 1.05), "below, but its interval reaches the norm");
  EXPECT_EQ(judged(1.25, 1.15, 1.35), "above, but its interval reaches the norm");
  EXPECT_EQ(judged(1.02, 0.95, 1.09), "within, but its interval reaches beyond");
  EXPECT_EQ(judged(kNaN, kNaN, kNaN), "");
  // An end that is not there may lie anywhere.
  const auto one_sided = [&](data::IntervalKind kind, double value, double low, double high) {
    auto of_side = measure("Left", value, low, high);
    of_side.interval.kind = kind;
    return rows_of({of_side}, {norm})[0].judgement[0];
  };
  EXPECT_EQ(one_sided(data::IntervalKind::at_most, 1.3, kNaN, 1.4),
            "above, but its interval reaches the norm");
  EXPECT_EQ(one_sided(data::IntervalKind::at_most, 0.9, kNaN, 0.95), "below");
  EXPECT_EQ(one_sided(data::IntervalKind::at_least, 0.9, 0.8, kNaN),
            "below, but its interval reaches the norm");
}

TEST(GaitTables, NormsOfASideAndOfAnotherUnit) {
  const std::vector<NormMeasure> norms{
      {.id = "stride_time", .side = Side::left, .unit = "s", .low = 1.0, .high = 1.2},
      {.id = "stride_time", .unit = "ms", .low = 900, .high = 950}};
  const auto rows = rows_of({measure("Left", 1.1, 1.0, 1.2), measure("Right", 1.1, 1.0, 1.2)}, norms);
  EXPECT_EQ(rows[0].norm, "1 to 1.2");
  EXPECT_EQ(rows[0].judgement[1], "");
}

TEST(GaitTables, OneSidedIntervalsAndWhatIsNotDetermined) {
  auto most = measure("", 1.0, kNaN, 1.2), least = measure("Left", 1.0, 0.9, kNaN),
       bare = measure("Right", 1.0, 0, 0);
  most.interval.kind = data::IntervalKind::at_most;
  least.interval.kind = data::IntervalKind::at_least;
  bare.interval = {};
  EXPECT_THAT(rows_of({least, bare, most})[0].value, ElementsAre("1 [at least 0.9]", "1", "1 [at most 1.2]"));
  EXPECT_EQ(rows_of({measure("Left", kNaN, kNaN, kNaN)})[0].value[0], "not determined");
}

TEST(GaitTables, RegionsHaveRowsOfTheirOwn) {
  auto slow = measure("Left", 1.0, 0.9, 1.1), fast = slow;
  slow.region = "slow", fast.region = "fast";
  const auto rows = rows_of({slow, fast});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].region, "fast");
}

}  // namespace
}  // namespace kinemark::pipeline

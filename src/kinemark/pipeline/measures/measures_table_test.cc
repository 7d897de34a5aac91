// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::pipeline {
namespace {

std::vector<data::Measure> measures() {
  data::Measure length{
      .id = "path_length", .subject = "R, \"FIN\"", .region = "reach", .start_s = 0.5, .end_s = 1.2};
  length.value = 0.3041234567891;
  length.uncorrected = 0.305;
  length.sd = 0.0004;
  length.interval = {.kind = data::IntervalKind::two_sided, .low = 0.3033, .high = 0.3049, .level = 0.95};
  length.share_not_measured = 0.125;
  length.method = "order 4, 7.5 Hz, 99 refits";
  data::Measure plane = length;
  plane.id = "plane_sd";
  plane.value = 0.0002;
  plane.interval = {.kind = data::IntervalKind::at_most, .high = 0.0008};
  plane.remark = "not distinguishable from 0";
  data::Measure onset = length;
  onset.id = "onset";
  onset.quantity = data::Quantity::time;
  onset.value = onset.sd = onset.uncorrected = kNaN;
  onset.interval = {};
  onset.remark = "the span does not begin and end at rest";
  return {length, plane, onset};
}

TEST(MeasuresCsv, HasOneRowEachInTheUnitOfTheField) {
  const std::string text = measures_csv(
      measures(), {.file = "walk.c3d", .participant = "sub-1", .trial = "walk", .more = {{"age", "34"}}});
  EXPECT_EQ(std::ranges::count(text, '\n'), 4);
  EXPECT_TRUE(text.starts_with("file,participant,session,trial,subject,context,region,cycle,")) << text;
  EXPECT_NE(text.find(",method,remark,age\n"), std::string::npos) << text;
  EXPECT_NE(text.find("walk.c3d,sub-1,,walk,\"R, "
                      "\"\"FIN\"\"\",,reach,,0.5,1.2,path_length,304.123457,mm,303.3,304.9,0.95,two-sided,no,"
                      "0.4,305,0.125,\"order 4, 7.5 Hz, 99 refits\",,34\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("plane_sd,0.2,mm,,0.8,0.95,at most,no,"), std::string::npos) << text;
  EXPECT_NE(text.find("onset,,s,,,0.95,none,no,,,0.125,"), std::string::npos) << text;
}

TEST(MeasuresJson, HasNullWhereNothingIsDetermined) {
  const auto json = measures_json(measures());
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["measure"], "path_length");
  EXPECT_EQ(json[0]["unit"], "mm");
  EXPECT_NEAR(json[0]["value"].get<double>(), 304.1234567891, 1e-9);
  EXPECT_EQ(json[0]["interval"]["kind"], "two-sided");
  EXPECT_FALSE(json[0].contains("remark"));
  EXPECT_TRUE(json[1]["interval"]["low"].is_null());
  EXPECT_TRUE(json[2]["value"].is_null());
  EXPECT_EQ(json[2]["remark"], "the span does not begin and end at rest");
}

TEST(MeasuresText, RoundsToWhatTheIntervalSupports) {
  const std::string text = measures_text(measures());
  EXPECT_NE(text.find("R, \"FIN\", reach, 0.500 to 1.200 s, 12.5 % not measured\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("304.1 [303.3 to 304.9] mm\n"), std::string::npos) << text;
  EXPECT_NE(text.find("0.20 [at most 0.80] mm  (not distinguishable from 0)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("not determined  (the span does not begin"), std::string::npos) << text;
}

TEST(MeasureList, HasALineForEachWithFormulaAndSource) {
  const std::string text = measure_list();
  const auto all = analysis::path_definitions().size() + analysis::rhythm_definitions().size() +
                   analysis::gait_definitions().size() + analysis::force_definitions().size() +
                   analysis::emg_definitions().size() + analysis::body_definitions().size();
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), all);
  EXPECT_NE(text.find("sum of |x[i+1] - x[i]|"), std::string::npos);
  EXPECT_NE(text.find("(Poizner, Wooten & Salot 1986)"), std::string::npos);
  EXPECT_EQ(measure_list_json().size(), all);
  EXPECT_EQ(measure_list_json(workflow::MeasuresOf::muscles).size(), analysis::emg_definitions().size());
  EXPECT_EQ(measure_list_json(workflow::MeasuresOf::walking).size(),
            analysis::gait_definitions().size() + analysis::force_definitions().size());
  EXPECT_EQ(measure_list(workflow::MeasuresOf::paths).find("cadence"), std::string::npos);
}

}  // namespace
}  // namespace kinemark::pipeline

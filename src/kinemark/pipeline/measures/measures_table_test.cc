// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_table.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::pipeline {
namespace {

// The noise of a marker behind a quintic spline at 6.1 Hz.
analysis::PathNoise splined() {
  analysis::PathNoise noise{.subject = "KNE", .source = analysis::NoiseSource::spectrum, .rate_hz = 100.0};
  noise.model = {.kind = math::NoiseKind::filtered,
                 .form = math::LowPass::spline,
                 .order = 3,
                 .variance = 1e-8,
                 .half = 0.07};
  noise.cutoff_hz = {.low = 5.8, .middle = 6.1, .high = 6.4};
  return noise;
}

TEST(NoisesJson, OfAFilterHasItsFormAndCutOff) {
  auto noise = splined();
  noise.slow_sd_m = {.low = 1e-4, .middle = 1.2e-4, .high = 1.4e-4};
  const auto json = noises_json({&noise, 1});
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["subject"], "KNE");
  EXPECT_EQ(json[0]["kind"], "filtered");
  EXPECT_EQ(json[0]["filter"]["form"], "quintic spline");
  EXPECT_FALSE(json[0]["filter"]["agreed"].get<bool>()) << "one marker alone";
  EXPECT_DOUBLE_EQ(json[0]["filter"]["cutoff_hz"].get<double>(), 6.1);
  EXPECT_NEAR(json[0]["sd_mm"].get<double>(), 0.1, 1e-9);
  EXPECT_FALSE(json[0]["slow_noise_unknown"].get<bool>());
  EXPECT_TRUE(json[0]["found_mm"].is_null());
  EXPECT_FALSE(json[0].contains("correlation"));
  EXPECT_FALSE(json[0].contains("stated_mm"));
}

TEST(NoisesJson, SaysWhichMarkersAgreeOnAFilter) {
  const auto noise = splined();
  std::vector<analysis::PathNoise> markers(4, noise);
  markers[3].cutoff_hz = {.low = 11.8, .middle = 12.1, .high = 12.4};
  auto json = noises_json(markers);
  for (std::size_t m = 0; m < 4; ++m) EXPECT_EQ(json[m]["filter"]["agreed"].get<bool>(), m < 3) << m;
  markers[1].cutoff_hz = {.low = 21.8, .middle = 22.1, .high = 22.4};
  json = noises_json(markers);
  for (const auto& one : json) EXPECT_FALSE(one["filter"]["agreed"].get<bool>());
  markers[1].source = analysis::NoiseSource::filter;
  EXPECT_TRUE(noises_json(markers)[1]["filter"]["agreed"].get<bool>()) << "the recording names it";
}

TEST(NoisesJson, OfCorrelatedNoiseHasItsTime) {
  analysis::PathNoise noise{.subject = "TOE", .source = analysis::NoiseSource::stated, .rate_hz = 100.0};
  noise.model = {.kind = math::NoiseKind::correlated, .variance = 1e-6, .correlation = 0.9};
  noise.stated_sd_m = 1e-3;
  noise.slow_sd_m = {.low = 1e-4, .middle = 3e-4, .high = 9e-4};
  const auto json = noises_json({&noise, 1});
  EXPECT_EQ(json[0]["source"], "stated");
  EXPECT_NEAR(json[0]["correlation_time_s"].get<double>(), 0.095, 0.001);
  EXPECT_DOUBLE_EQ(json[0]["stated_mm"].get<double>(), 1.0);
  EXPECT_TRUE(json[0]["slow_noise_unknown"].get<bool>());
  EXPECT_FALSE(json[0].contains("filter"));
}

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

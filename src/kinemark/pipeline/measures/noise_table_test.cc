// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/noise_table.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

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

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/example_clean.h"

namespace kinemark::report {
namespace {

using internal::example_clean;
using Json = nlohmann::ordered_json;

TEST(CleanSummaryJson, SaysWhatItIsAndHoldsTheRun) {
  const Json json = clean_summary_json(example_clean(1200).finished());
  EXPECT_EQ(json.begin().key(), "schema");
  EXPECT_EQ(json["schema"], "kinemark.clean_report");
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["trial"], "reach_07.c3d");
  EXPECT_EQ(json["gap_method"], "auto");
  EXPECT_EQ(json["verdict"], "attention");
  EXPECT_EQ(json["frames"], 1200);
  EXPECT_EQ(json["rate_hz"], 120.0);
  EXPECT_EQ(json["seed"], 1);
  EXPECT_EQ(json["options"]["max_gap_s"], "2");
  EXPECT_EQ(json["inputs"][0]["hash"], "5be1093c77d2a8f0");
  EXPECT_EQ(json["warnings"].size(), 1U);
}

TEST(CleanSummaryJson, EveryKeyIsDescribed) {
  const Json json = clean_summary_json(example_clean(1200).finished());
  EXPECT_EQ(json.size(), 29U) << "a new key belongs into viewer/schema/clean.json too";
  EXPECT_EQ(json["markers"][0].size(), 28U);
  EXPECT_EQ(json["gaps"][0].size(), 18U);
  EXPECT_EQ(json["defects"][0].size(), 11U);
}

TEST(CleanSummaryJson, SamplesByStateAddUp) {
  const Json json = clean_summary_json(example_clean(1200).finished());
  for (const char* side : {"before", "after"}) {
    std::int64_t sum = 0;
    for (const auto& [state, n] : json[side].items()) {
      std::int64_t of_markers = 0;
      for (const Json& m : json["markers"]) of_markers += m[side][state].get<std::int64_t>();
      EXPECT_EQ(n, of_markers) << state;
      sum += of_markers;
    }
    EXPECT_EQ(sum, 12 * 1200);
  }
  EXPECT_EQ(json["after"]["rejected"], 1);
  EXPECT_EQ(json["after"]["upsampled"], 2 * 600);
  EXPECT_EQ(json["after"]["interpolated"], 12);
  EXPECT_EQ(json["after"]["missing"], 300);
}

TEST(CleanSummaryJson, AMarkerSumsItsGaps) {
  const Json json = clean_summary_json(example_clean(1200).finished());
  const Json& bicep = json["markers"][3];
  EXPECT_EQ(bicep["name"], "R.Bicep");
  EXPECT_EQ(bicep["gaps_filled"], 2);
  EXPECT_EQ(bicep["gaps_open"], 0);
  EXPECT_EQ(bicep["largest_fill_sd_mm"], 0.9);
  const Json& finger = json["markers"][11];
  EXPECT_EQ(finger["gaps_open"], 1);
  EXPECT_EQ(finger["longest_open_s"], 2.5);
  EXPECT_TRUE(finger["largest_fill_sd_mm"].is_null());
  EXPECT_EQ(finger["white"], false);
  EXPECT_EQ(finger["white_departure"], 0.31);
  EXPECT_EQ(json["markers"][0]["white"], true);
  EXPECT_EQ(json["markers"][0]["gaps_filled"], 0);
}

TEST(CleanSummaryJson, WhiteIsNullWhereItWasNotJudged) {
  CleanReport r = example_clean(1200).finished();
  r.account.markers[0].white_p = r.account.markers[0].white_departure = kNaN;
  const Json m = clean_summary_json(r)["markers"][0];
  EXPECT_TRUE(m["white"].is_null());
  EXPECT_TRUE(m["white_p"].is_null());
}

TEST(CleanSummaryJson, UnitsAreThoseOfTheReader) {
  CleanReport r = example_clean(1200).finished();
  r.account.markers[0].used.noise_sd_m = 0.000123456789;
  r.account.markers[0].spectrum = {{1.0, 10.0}, {2.5e-8, 1.0}, {kNaN, 1e-12}};
  r.account.markers[0].candidates = {{3, 7.25, 4.0e-9}};
  const Json m = clean_summary_json(r)["markers"][0];
  EXPECT_EQ(m["noise_sd_mm"], 0.12346);
  EXPECT_EQ(m["spectrum"]["raw_mm2_per_hz"][0], 0.025);
  EXPECT_TRUE(m["spectrum"]["residual_mm2_per_hz"][0].is_null());
  EXPECT_EQ(m["spectrum"]["residual_mm2_per_hz"][1], 1e-6);
  EXPECT_EQ(m["tried"][0]["criterion"], 4e-9) << "its unit is in its name";
}

TEST(CleanSummaryJson, AGapTellsItsStory) {
  const Json json = clean_summary_json(example_clean(1200).finished());
  const Json& ulna = json["gaps"][2];
  EXPECT_EQ(ulna["marker"], "R.Wrist.Ulna");
  EXPECT_EQ(ulna["how"], "auto: 61 % regression, tied; 31 % rigid; 8 % cubic");
  EXPECT_EQ(ulna["first_frame"], 540);
  EXPECT_EQ(ulna["first_time_s"], 4.5);
  EXPECT_EQ(ulna["length_s"], 1.1) << "the frame after the last is measured again";
  EXPECT_EQ(ulna["max_sd_mm"], 14.2);
  EXPECT_EQ(ulna["weights"].size(), 4U);
  EXPECT_TRUE(ulna["weights"][3]["guarded"]);
  EXPECT_EQ(ulna["dropped"][0], "R.Wrist.Rad");
  const Json& finger = json["gaps"][5];
  EXPECT_FALSE(finger["filled"]);
  EXPECT_EQ(finger["how"], "");
  EXPECT_TRUE(finger["sd_mm"].is_null());
  EXPECT_EQ(finger["why_open"], "2.5 s long; at most 2 s are filled");
}

TEST(CleanSummaryJson, AMarkerTellsWhatTheRecorderDidToIt) {
  CleanReport r = example_clean(1200).finished();
  r.account.upsampling.marker_bands[1].verdict = data::BandVerdict::low_passed;
  const Json markers = clean_summary_json(r)["markers"];
  EXPECT_EQ(markers[6]["upsampling_factor"], 2);
  EXPECT_EQ(markers[6]["upsampling_kernel"], "linear");
  EXPECT_EQ(markers[0]["upsampling_factor"], 1);
  EXPECT_EQ(markers[0]["upsampling_kernel"], "");
  EXPECT_EQ(markers[0]["band"], "open");
  EXPECT_EQ(markers[1]["band"], "low-passed or model-generated");
  r.account.upsampling = {};
  const Json nobody_looked = clean_summary_json(r);
  EXPECT_EQ(nobody_looked["upsampling"]["looked"], false);
  EXPECT_EQ(nobody_looked["markers"][6]["upsampling_factor"], 1);
  EXPECT_EQ(nobody_looked["markers"][6]["band"], "");
}

TEST(CleanSummaryJson, ADefectIsReportedByNames) {
  const Json defects = clean_summary_json(example_clean(1200).finished())["defects"];
  EXPECT_EQ(defects[0]["kind"], "spike");
  EXPECT_EQ(defects[0]["marker"], "R.Finger");
  EXPECT_EQ(defects[0]["other_marker"], "");
  EXPECT_EQ(defects[1]["kind"], "label swap");
  EXPECT_EQ(defects[1]["other_marker"], "R.Elbow.Med");
}

TEST(CleanSummaryJson, RefusesAnAccountOfMarkersThatAreNotThere) {
  CleanReport r = example_clean(1200).finished();
  r.account.gaps[0].marker = 12;
  EXPECT_ANY_THROW((void)clean_summary_json(r));
}

TEST(CleanSummaryJson, AnEmptyReportIsStillOne) {
  CleanReport r;
  r.time = {.rate_hz = 100.0};
  const Json json = clean_summary_json(r);
  EXPECT_EQ(json["verdict"], "good");
  EXPECT_TRUE(json["clean_s"].is_null());
  EXPECT_EQ(json["markers"].dump(), "[]");
  EXPECT_EQ(json["options"].dump(), "{}");
}

TEST(CleanText, SingleMethodsHaveNoShares) {
  data::GapAccount g{.filled = true, .method = "cubic"};
  EXPECT_EQ(internal::how_filled(g), "cubic");
  g.weights = {{"cubic", 1.0, 0.001, false}};
  EXPECT_EQ(internal::how_filled(g), "cubic");
  g.method = "auto";
  g.weights = {{"rigid", 0.998, 0.001, false}, {"cubic", 0.002, 0.01, false}};
  EXPECT_EQ(internal::how_filled(g), "auto: 100 % rigid");
  g.filled = false;
  EXPECT_EQ(internal::how_filled(g), "");
}

TEST(CleanText, StatesAreRankedByHowBadTheyAre) {
  using data::SampleState;
  std::set<std::uint8_t> ranks;
  for (int s = 0; s < 6; ++s) ranks.insert(internal::state_rank(static_cast<SampleState>(s)));
  EXPECT_EQ(ranks.size(), 6U) << "each state has its own";
  EXPECT_EQ(internal::state_rank(SampleState::measured), 0);
  EXPECT_EQ(internal::state_rank(SampleState::missing), 4) << "from here on there are no coordinates";
  EXPECT_EQ(internal::state_rank(SampleState::rejected), 5);
}

}  // namespace
}  // namespace kinemark::report

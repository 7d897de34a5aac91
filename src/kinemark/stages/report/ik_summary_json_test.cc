// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/stages/report/internal/example_trial.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

IkSummary example_summary() {
  const auto t = internal::example_trial(200);
  return summarize(t.run, t.motion, &t.markers).value();
}

TEST(SummaryJson, HasTheUnitsThatItsNamesSay) {
  IkSummary s = example_summary();
  s.coordinates[0].max = 90.0 * kRadPerDeg;
  s.coordinates[3].max = 1.25;
  s.markers[0].rms_error_m = 0.0123456789;
  s.rms_error_m = 0.005;
  const Json json = summary_json(s);
  EXPECT_EQ(json["schema"], "kinemark.ik_report");
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["verdict"], "attention");
  EXPECT_EQ(json["coordinates"][0]["unit"], "deg");
  EXPECT_EQ(json["coordinates"][0]["max"], 90.0);
  EXPECT_EQ(json["coordinates"][3]["unit"], "m");
  EXPECT_EQ(json["coordinates"][3]["max"], 1.25);
  EXPECT_EQ(json["markers"][0]["rms_error_mm"], 12.3457) << "rounded to 0.1 micrometre";
  EXPECT_EQ(json["rms_error_mm"], 5.0);
  EXPECT_EQ(json["frames_per_s"], 14200.0);
  EXPECT_EQ(json["status_frames"]["converged"], 200);
  EXPECT_EQ(json["findings"][0]["level"], "attention");
  EXPECT_EQ(json["options"]["accuracy"], "1e-9");
  EXPECT_EQ(json["inputs"][1]["bytes"], 431207);
}

TEST(SummaryJson, UnknownNumbersAreNull) {
  IkSummary s = example_summary();
  s.run.solve_s = kNaN;
  s.rms_error_m = kNaN;
  const Json json = summary_json(s);
  EXPECT_TRUE(json["solve_s"].is_null());
  EXPECT_TRUE(json["frames_per_s"].is_null());
  EXPECT_TRUE(json["rms_error_mm"].is_null());
  EXPECT_TRUE(json["markers"].back()["noise_sd_mm"].is_null());
  EXPECT_EQ(json.dump().find("nan"), std::string::npos);
}

TEST(SummaryJson, EveryKeyIsDescribedInOrderOfImportance) {
  const Json json = summary_json(example_summary());
  EXPECT_EQ(json.begin().key(), "schema");
  EXPECT_EQ(json.size(), 34U) << "a new key belongs into viewer/schema/ik.json too";
}

TEST(RunFromJson, LimitsAndMassComeBackAndMayBeMissing) {
  IkSummary s = example_summary();
  s.run.mass_kg = 71.5;
  s.coordinates[0].limit_min = -1.0;
  s.coordinates[0].limit_max = 2.0;
  auto json = Json::parse(summary_json(s).dump());
  const auto back = run_from_json(json);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_DOUBLE_EQ(back->mass_kg, 71.5);
  ASSERT_EQ(back->limits.size(), 1U);
  EXPECT_EQ(back->limits[0].coordinate, s.coordinates[0].name);
  EXPECT_NEAR(back->limits[0].min, -1.0, 1e-6);
  EXPECT_NEAR(back->limits[0].max, 2.0, 1e-6);
  json.erase("mass_kg");
  for (auto& c : json["coordinates"]) c.erase("limits");
  const auto old = run_from_json(json);
  ASSERT_TRUE(old) << "reports of earlier versions have neither";
  EXPECT_TRUE(old->limits.empty());
  EXPECT_TRUE(std::isnan(old->mass_kg));
}

TEST(RunFromJson, ReadsBackWhatWasWritten) {
  const IkSummary s = example_summary();
  const auto back = run_from_json(Json::parse(summary_json(s).dump()));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->trial, s.run.trial);
  EXPECT_EQ(back->model, s.run.model);
  EXPECT_EQ(back->options, s.run.options);
  EXPECT_EQ(back->warnings, s.run.warnings);
  EXPECT_EQ(back->locked_coordinates, s.run.locked_coordinates);
  EXPECT_EQ(back->seed, s.run.seed);
  ASSERT_EQ(back->gates.size(), 2U);
  EXPECT_FALSE(back->gates[1].passed);
  EXPECT_EQ(back->inputs[0].hash, s.run.inputs[0].hash);
  ASSERT_EQ(back->fit.markers.size() + back->fit.excluded.size(), s.markers.size());
  EXPECT_NEAR(back->fit.markers[0].total_sd_m(), s.markers[0].noise_sd_m, 1e-7);
  EXPECT_EQ(back->fit.excluded.back().why, "it is at the origin in every frame.");
}

TEST(RunFromJson, ASummaryMadeFromWhatWasReadWritesTheSameJson) {
  const auto t = internal::example_trial(200);
  const Json first = summary_json(summarize(t.run, t.motion, &t.markers).value());
  const auto run = run_from_json(first);
  ASSERT_TRUE(run);
  const Json second = summary_json(summarize(*run, t.motion, &t.markers).value());
  EXPECT_EQ(first, second);
}

// Marker 12 in frame 358.
void leave_out(IkRun& run) {
  for (auto& marker : run.fit.markers) marker.rejected_frames = 0;
  run.fit.markers[12].rejected_frames = 1;
  run.fit.findings.push_back({.kind = data::FindingKind::outlier,
                              .subject = run.fit.markers[12].name,
                              .first_frame = 358,
                              .last_frame = 358,
                              .size = 0.0431,
                              .detail = "it lies where 'R.Heel' should"});
}

TEST(RunFromJson, KeepsWhatWasLeftOut) {
  auto t = internal::example_trial(400);
  leave_out(t.run);
  const Json first = summary_json(summarize(t.run, t.motion, &t.markers).value());
  EXPECT_EQ(first["rejected_samples"], 1);
  EXPECT_GT(first["rejected_fraction"], 0.0);
  EXPECT_EQ(first["rejected"].size(), 1U);
  EXPECT_EQ(first["markers"][12]["rejected_frames"], 1);
  const auto run = run_from_json(first);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(summary_json(summarize(*run, t.motion, &t.markers).value()), first);
}

TEST(RunFromJson, KeepsWhatWasExchangedBack) {
  auto t = internal::example_trial(200);
  t.motion.time.first_number = 1001;
  data::Finding swap{.kind = data::FindingKind::label_swap,
                     .subject = t.run.fit.markers[3].name,
                     .partner = t.run.fit.markers[5].name,
                     .first_frame = 1,
                     .last_frame = 127,
                     .size = 0.0431};
  auto third = swap;
  for (std::int64_t f = 1; f < 128; f += 3) third.frames.push_back(f);
  t.run.fit.findings = {third, swap};
  const Json first = summary_json(summarize(t.run, t.motion, &t.markers).value());
  ASSERT_EQ(first["exchanged"].size(), 2U);
  EXPECT_EQ(first["exchanged"][0]["frames"], "1002-1128/3") << "the recording's own numbers";
  EXPECT_EQ(first["exchanged"][0]["count"], 43);
  EXPECT_EQ(first["exchanged"][0]["apart_mm"], 43.1);
  EXPECT_EQ(first["exchanged"][1]["frames"], "1002-1128");
  EXPECT_EQ(first["exchanged"][1]["count"], 127);
  EXPECT_EQ(first["rejected"].size(), 0U) << "nothing was left out";
  const auto run = run_from_json(first);
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->fit.findings.size(), 2U);
  EXPECT_EQ(run->fit.findings[0].frames, third.frames);
  EXPECT_EQ(run->fit.findings[1].frame_count(), 127);
  EXPECT_EQ(summary_json(summarize(*run, t.motion, &t.markers).value()), first);
  Json old = first;
  old.erase("exchanged");
  EXPECT_TRUE(run_from_json(old)->fit.findings.empty()) << "reports of earlier versions have none";
}

TEST(RunFromJson, FramesOfEarlierReportsCountFromTheFirstOfTheMotion) {
  auto t = internal::example_trial(400);
  t.motion.time.first_number = 1001;
  leave_out(t.run);
  Json json = summary_json(summarize(t.run, t.motion, &t.markers).value());
  EXPECT_EQ(json["rejected"][0]["first_frame"], 1359);
  EXPECT_GT(json["worst_frames"][0]["frame"], 1000);
  EXPECT_EQ(run_from_json(json)->fit.findings.back().first_frame, 358);
  json["schema_version"] = 1;
  json["rejected"][0]["first_frame"] = json["rejected"][0]["last_frame"] = 358;
  EXPECT_EQ(run_from_json(json)->fit.findings.back().first_frame, 358);
}

TEST(SummaryJson, OpenFramesAreNullWhereTheyAreNotKnown) {
  auto t = internal::example_trial(200);
  t.motion.open_frames.clear();
  EXPECT_TRUE(summary_json(summarize(t.run, t.motion, &t.markers).value())["coordinates"][0]["open_frames"]
                  .is_null());
  t.motion.open_frames.assign(t.motion.coordinates.size(), 0);
  t.motion.open_frames[1] = 17;
  const Json json = summary_json(summarize(t.run, t.motion, &t.markers).value());
  EXPECT_EQ(json["coordinates"][0]["open_frames"], 0);
  EXPECT_EQ(json["coordinates"][1]["open_frames"], 17);
}

TEST(RunFromJson, NothingLeftOutIsNotTheSameAsNotJudged) {
  auto t = internal::example_trial(200);
  EXPECT_TRUE(summary_json(summarize(t.run, t.motion, &t.markers).value())["rejected_fraction"].is_null());
  for (auto& marker : t.run.fit.markers) marker.rejected_frames = 0;
  const Json judged = summary_json(summarize(t.run, t.motion, &t.markers).value());
  EXPECT_EQ(judged["rejected_fraction"], 0.0);
  EXPECT_EQ(run_from_json(judged)->fit.markers[0].rejected_frames, 0);
}

TEST(RunFromJson, SamplesLeftOutThatCannotBeAreBadInput) {
  const auto t = internal::example_trial(200);
  Json json = summary_json(summarize(t.run, t.motion, &t.markers).value());
  json["rejected"].push_back({{"marker", t.run.fit.markers[0].name},
                              {"first_frame", 190},
                              {"last_frame", 200},
                              {"distance_mm", 3.0},
                              {"why", ""}});
  const auto late = summarize(run_from_json(json).value(), t.motion, &t.markers);
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, HasSubstr("names frame 200; the joint motion has 200"));
  json["rejected"][0]["last_frame"] = 180;
  EXPECT_EQ(summarize(run_from_json(json).value(), t.motion, &t.markers).error().code, Code::bad_input);
}

TEST(RunFromJson, SaysWhatIsWrong) {
  const Json good = summary_json(example_summary());
  EXPECT_THAT(run_from_json(Json::array()).error().message, HasSubstr("not a kinemark IK report"));
  Json json = good;
  json["schema"] = 3;
  EXPECT_EQ(run_from_json(json).error().code, Code::bad_input);
  json = good;
  json["schema_version"] = 3;
  EXPECT_EQ(run_from_json(json).error().code, Code::not_supported);
  json = good;
  json.erase("trial");
  EXPECT_THAT(run_from_json(json).error().message, HasSubstr("trial"));
  for (const char* key : {"markers", "gates", "options", "inputs", "warnings", "coordinates", "seed"}) {
    json = good;
    json[key] = "text";
    EXPECT_FALSE(run_from_json(json)) << key;
  }
}

}  // namespace
}  // namespace kinemark::report

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_json.h"

#include <gmock/gmock.h>

#include "kinemark/core/version.h"

namespace kinemark::pipeline {
namespace {

ScaleOutcome two_bodies() {
  ScaleOutcome outcome;
  outcome.model.name = "Ann";
  outcome.model.bodies.resize(2);
  outcome.model.bodies[0].mass = 50.0;
  outcome.model.bodies[1].mass = 12.5;
  outcome.factors = {{.body = "trunk", .factors = {1.0, 1.1, 1.2}}, {.body = "arm"}};
  return outcome;
}

TEST(ScaleJson, TellsModelMassAndFactors) {
  ScaleJob job;
  job.command_line = "kinemark scale";
  const auto json = scale_json(job, two_bodies());
  EXPECT_EQ(json["format"], "kinemark-scale");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["program"], kVersion);
  EXPECT_EQ(json["command"], "kinemark scale");
  EXPECT_EQ(json["model"], "Ann");
  EXPECT_EQ(json["mass_kg"], 62.5);
  EXPECT_EQ(json["exit_status"], 0);
  EXPECT_EQ(json["notes"].dump(), "[]");
  EXPECT_EQ(json["factors"].dump(), R"({"trunk":[1.0,1.1,1.2],"arm":[1.0,1.0,1.0]})");
  for (const char* step : {"measurements", "placed", "static", "motion"})
    EXPECT_FALSE(json.contains(step)) << step << " was not asked for";
}

TEST(ScaleJson, AMissedGateIsItsExitStatus) {
  auto outcome = two_bodies();
  outcome.gates.push_back({.name = "marker_rms", .passed = false, .sentence = "too far"});
  outcome.warnings = {"too far"};
  const auto json = scale_json({}, outcome);
  EXPECT_EQ(json["exit_status"], 1);
  EXPECT_EQ(json["notes"], nlohmann::json({"too far"}));
}

TEST(ScaleJson, EveryStepHasItsPart) {
  auto outcome = two_bodies();
  outcome.clavicles = {"clavicle_l"};
  outcome.scaled.emplace();
  outcome.scaled->measurements = {
      {.name = "thigh",
       .factor = 1.05,
       .pairs = {
           {.first = "RHIP", .second = "RKNE", .measured_m = 0.42, .measured_sd_m = 0.001, .model_m = 0.4}}}};
  outcome.placed.emplace();
  outcome.placed->rms_m = 0.01;
  outcome.placed->unseen = {"LTOE"};
  outcome.placed->markers = {
      {.name = "RKNE", .body = "arm", .after_in_body = {0.0, 0.0, 0.5}, .fixed = true}};
  const auto json = scale_json({}, outcome);
  EXPECT_EQ(json["clavicles"], nlohmann::json({"clavicle_l"}));
  EXPECT_EQ(json["measurements"].dump(),
            R"([{"name":"thigh","factor":1.05,"pairs":[{"markers":["RHIP","RKNE"],"measured_m":0.42,)"
            R"("measured_sd_m":0.001,"model_m":0.4}]}])");
  EXPECT_EQ(json["placed"]["rms_m"], 0.01);
  EXPECT_EQ(json["placed"]["not_in_static_trial"], nlohmann::json({"LTOE"}));
  EXPECT_EQ(json["placed"]["markers"][0]["after_in_body_m"], nlohmann::json({0.0, 0.0, 0.5}));
  EXPECT_EQ(json["placed"]["markers"][0]["fixed"], true);
}

TEST(ScaleJson, AnAdaptedSizeCarriesItsInterval) {
  auto outcome = two_bodies();
  motion::AdaptResult adapted;
  adapted.frames = 20;
  adapted.converged = true;
  adapted.parameters = {
      {.name = "arm size", .initial = 1.0, .value = 1.02, .prior_sd = 0.1, .sd = 0.01, .determined = true},
      {.name = "elbow",
       .kind = motion::ParameterKind::joint_offset,
       .prior_sd = 0.1,
       .sd = 0.05,
       .data_sd = 0.5}};
  adapted.lengths = {{.name = "arm", .initial_m = 0.3, .length_m = 0.306, .sd_m = 0.003, .determined = true}};
  adapted.not_determined = {"elbow"};
  outcome.from_static = adapted;
  adapted.frames = 500;
  outcome.from_motion = adapted;
  const auto json = scale_json({}, outcome);
  EXPECT_EQ(json["static"]["frames"], 20);
  EXPECT_EQ(json["motion"]["frames"], 500);
  const auto& parameters = json["motion"]["parameters"];
  EXPECT_EQ(parameters[0]["kind"], "size");
  EXPECT_EQ(parameters[0]["sd"], 0.01);
  EXPECT_EQ(parameters[1]["kind"], "joint place");
  EXPECT_EQ(parameters[1]["sd"], 0.5) << "what the data leave open is told wider than the prior allows";
  EXPECT_EQ(json["motion"]["lengths"][0]["length_m"], 0.306);
  EXPECT_EQ(json["motion"]["not_determined"], nlohmann::json({"elbow"}));
}

}  // namespace
}  // namespace kinemark::pipeline

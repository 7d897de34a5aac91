// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/foundations/foundation_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kNames{"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE",
                                      "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"};

/// Every marker where its name says.
data::Trajectories standing() {
  const auto body = motion::body_of_names(kNames);
  auto out = data::Trajectories::all_missing(kNames, {.rate_hz = 100.0, .frames = 5});
  for (std::int64_t f = 0; f < 5; ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const auto& marker = body.markers[static_cast<std::size_t>(m)];
      Vector3d x = marker.x_in_segment;
      for (int s = marker.segment; s >= 0; s = body.segments[at(s)].parent)
        x += body.segments[at(s)].joint_in_parent;
      out.x(f, m) = x;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(FoundationGate, PassesACleanTrialAndSaysSo) {
  JobOutcome outcome;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), standing(), {}, outcome);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_EQ(outcome.exit_status(), 0);
  EXPECT_TRUE(outcome.warnings.empty());
  ASSERT_EQ(outcome.gates.size(), 1);
  EXPECT_EQ(outcome.gates[0].name, "static_trial");
  EXPECT_TRUE(outcome.gates[0].passed);
  EXPECT_EQ(outcome.gates[0].value, 0.0);
  EXPECT_THAT(outcome.gates[0].sentence, HasSubstr("No marker of cal.c3d lies where a body cannot have it."));
  EXPECT_THAT(outcome.gates[0].sentence, Not(HasSubstr("Everything below takes it as it is")));
  const auto json = foundation_json("cal.c3d", *judged);
  EXPECT_EQ(json["judged"].size(), kNames.size());
  EXPECT_TRUE(json["findings"].empty());
  EXPECT_EQ(json["movements"], 0);
}

TEST(FoundationGate, SaysWhereTheTrialMoves) {
  const auto body = motion::body_of_names(kNames);
  auto trial = data::Trajectories::all_missing(kNames, {.rate_hz = 100.0, .frames = 20});
  for (std::int64_t f = 0; f < trial.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers(); ++m) {
      trial.x(f, m) = standing().x(0, m);
      if (f >= 10 && kNames[at(m)] == "LANK") trial.x(f, m) += Vector3d(-0.2, 0.2, 0.0);
      trial.state[trial.index(f, m)] = data::SampleState::measured;
    }
  JobOutcome outcome;
  ASSERT_TRUE(judge_static_trial("cal.c3d", body, trial, {}, outcome));
  ASSERT_FALSE(outcome.warnings.empty());
  EXPECT_THAT(outcome.warnings[0], HasSubstr("cal.c3d is not still"));
  EXPECT_THAT(outcome.warnings[0],
              HasSubstr("a posture that is taken from all of it is a mean of different ones"));
}

TEST(FoundationGate, MissesAnExchangeAndNamesThePair) {
  auto trial = standing();
  const auto toe = trial.find("LTOE"), heel = trial.find("LHEE");
  for (std::int64_t f = 0; f < trial.frames(); ++f) {
    const Vector3d kept = trial.x(f, toe);
    trial.x(f, toe) = trial.x(f, heel);
    trial.x(f, heel) = kept;
  }
  JobOutcome outcome;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), trial, {}, outcome);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_EQ(outcome.exit_status(), 1);
  ASSERT_EQ(outcome.warnings.size(), 1);
  EXPECT_THAT(outcome.warnings[0], HasSubstr("LHEE and LTOE are exchanged in cal.c3d"));
  EXPECT_THAT(outcome.warnings[0], HasSubstr("Everything below takes it as it is; label it again or leave"));
  EXPECT_THAT(outcome.warnings[0], Not(HasSubstr("lies where a body cannot have it")));
  EXPECT_EQ(outcome.gates[0].sentence, outcome.warnings[0]);
  EXPECT_EQ(outcome.gates[0].value, 1.0);
  const auto json = foundation_json("cal.c3d", *judged);
  EXPECT_EQ(json["findings"][0]["partner"], "LTOE");
  EXPECT_FALSE(json["findings"][0].contains("shift_m"));
}

TEST(FoundationGate, WritesAShiftWithItsSpreadAndWithoutAPartner) {
  motion::FoundationJudgement judgement;
  judgement.judged = {"LKNE", "RKNE"};
  judgement.movements = 2;
  judgement.findings.push_back({.marker = "LKNE",
                                .shift_m = Vector3d(0.05, -0.02, 0.0),
                                .shift_sd_m = Vector3d(0.008, 0.007, 0.006),
                                .score = 31.0,
                                .by_movement = true,
                                .rivals = {"LTHI 70 mm off"}});
  const auto json = foundation_json("cal.c3d", judgement);
  EXPECT_EQ(json["file"], "cal.c3d");
  EXPECT_EQ(json["movements"], 2);
  const auto& one = json["findings"][0];
  EXPECT_TRUE(one["partner"].is_null());
  EXPECT_EQ(one["shift_m"][0], 0.05);
  EXPECT_EQ(one["shift_sd_m"][2], 0.006);
  EXPECT_TRUE(one["by_movement"]);
  EXPECT_EQ(one["rivals"][0], "LTHI 70 mm off");
  EXPECT_THAT(one["sentence"].get<std::string>(),
              HasSubstr("LKNE lies 54 mm (SD 8) from where it should in cal"));
}

TEST(FoundationGate, NamesEachOfTwoExchanges) {
  auto trial = standing();
  for (const auto& [a, b] : {std::pair{"LTOE", "LHEE"}, std::pair{"RASI", "RPSI"}}) {
    const auto i = trial.find(a), j = trial.find(b);
    for (std::int64_t f = 0; f < trial.frames(); ++f) {
      const Vector3d kept = trial.x(f, i);
      trial.x(f, i) = trial.x(f, j);
      trial.x(f, j) = kept;
    }
  }
  JobOutcome outcome;
  const auto judged = judge_static_trial("cal.c3d", motion::body_of_names(kNames), trial, {}, outcome);
  ASSERT_TRUE(judged) << judged.error().message;
  EXPECT_EQ(judged->findings.size(), 2U);
  ASSERT_EQ(outcome.warnings.size(), 1U) << "one gate, one sentence";
  EXPECT_THAT(outcome.warnings[0], HasSubstr("LHEE and LTOE are exchanged"));
  EXPECT_THAT(outcome.warnings[0], HasSubstr("RASI and RPSI are exchanged"));
  EXPECT_EQ(outcome.exit_status(), 1);
}

TEST(FoundationGate, IsNotThereWhereNothingCanBeJudged) {
  JobOutcome outcome;
  const auto nobody = data::Trajectories::all_missing({"a", "b"}, {.rate_hz = 100.0, .frames = 2});
  ASSERT_TRUE(judge_static_trial("cal.c3d", motion::body_of_names(nobody.names), nobody, {}, outcome));
  EXPECT_TRUE(outcome.gates.empty());
  EXPECT_TRUE(outcome.warnings.empty());
}

}  // namespace
}  // namespace kinemark::pipeline

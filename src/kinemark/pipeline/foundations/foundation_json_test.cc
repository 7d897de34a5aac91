// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/foundations/foundation_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

TEST(FoundationJson, OfACleanTrialNamesWhatWasJudged) {
  motion::FoundationJudgement judgement;
  judgement.judged = {"LKNE", "RKNE", "LTOE"};
  const auto json = foundation_json("cal.c3d", judgement);
  EXPECT_EQ(json["judged"].size(), 3U);
  EXPECT_TRUE(json["findings"].empty());
  EXPECT_EQ(json["movements"], 0);
  EXPECT_FALSE(json["mirrored"]);
}

TEST(FoundationJson, OfAnExchangeNamesThePairAndNoShift) {
  motion::FoundationJudgement judgement;
  judgement.judged = {"LHEE", "LTOE"};
  judgement.findings.push_back({.marker = "LHEE", .partner = "LTOE", .score = 40.0});
  const auto json = foundation_json("cal.c3d", judgement);
  EXPECT_EQ(json["findings"][0]["partner"], "LTOE");
  EXPECT_FALSE(json["findings"][0].contains("shift_m"));
}

TEST(FoundationJson, OfAMirroredTrialNamesNoMarker) {
  motion::FoundationJudgement judgement;
  judgement.judged = {"LHEE", "LTOE"};
  judgement.mirrored = true;
  const auto json = foundation_json("cal.c3d", judgement);
  EXPECT_TRUE(json["mirrored"]);
  EXPECT_TRUE(json["findings"].empty());
}

TEST(FoundationJson, WritesAShiftWithItsSpreadAndWithoutAPartner) {
  motion::FoundationJudgement judgement;
  judgement.judged = {"LKNE", "RKNE"};
  judgement.movements = 2;
  judgement.seen_at_50_mm = 0.4;
  judgement.findings.push_back({.marker = "LKNE",
                                .shift_m = Vector3d(0.05, -0.02, 0.0),
                                .shift_sd_m = Vector3d(0.008, 0.007, 0.006),
                                .score = 31.0,
                                .by_movement = true,
                                .where = motion::MistakeIn::either,
                                .rivals = {"LTHI 70 mm off"}});
  const auto json = foundation_json("cal.c3d", judgement);
  EXPECT_EQ(json["file"], "cal.c3d");
  EXPECT_EQ(json["movements"], 2);
  const auto& one = json["findings"][0];
  EXPECT_TRUE(one["partner"].is_null());
  EXPECT_EQ(one["shift_m"][0], 0.05);
  EXPECT_EQ(one["shift_sd_m"][2], 0.006);
  EXPECT_TRUE(one["by_movement"]);
  EXPECT_EQ(one["where"], "either");
  EXPECT_EQ(json["seen_at_50_mm"], 0.4);
  EXPECT_EQ(one["rivals"][0], "LTHI 70 mm off");
  EXPECT_THAT(one["sentence"].get<std::string>(),
              HasSubstr("LKNE lies 54 mm (SD 8) from where the movement has it in cal"));
}

}  // namespace
}  // namespace kinemark::pipeline

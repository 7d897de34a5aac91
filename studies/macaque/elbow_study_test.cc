// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/elbow_study.h"

#include <gtest/gtest.h>

namespace kinemark::studies {
namespace {

TEST(StudyElbow, OursIsAtTheBoundWhereTheReportIsFarOff) {
  const auto errors = study_elbow({.noise_m = 0.002, .frames = 200}, 1);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_EQ(errors->report.frames, 200);
  EXPECT_GT(errors->report.rms_answered_m(), 0.020);
  EXPECT_LT(errors->ours.rms_answered_m(), 0.0035);
  EXPECT_NEAR(errors->ours.over_bound(), 1.0, 0.15);
  EXPECT_EQ(errors->score.frames, 0);  // collinear markers give no pose
}

TEST(StudyElbow, StaggeredMarkersLetScoreAnswer) {
  const auto errors = study_elbow({.noise_m = 0.001, .missing = 0.2, .stagger_m = 0.02, .frames = 200}, 1);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_GT(errors->score.answered, 20);
  EXPECT_LT(errors->score.answered, 180);  // three markers on a segment are needed
  EXPECT_LT(errors->score.rms_answered_m(), 0.005);
  EXPECT_GT(errors->ours.share_determined(), 0.7);
}

TEST(StudyElbow, WithoutNoiseOnlyTheOthersAreAsked) {
  const auto errors = study_elbow({.noise_m = 0.0, .frames = 60}, 1).value();
  EXPECT_EQ(errors.ours.frames, 0);
  EXPECT_EQ(errors.report.frames, 60);
}

TEST(StudyElbow, ARecordingThatAMethodRefusesIsNotAnswered) {
  const auto errors = study_elbow({.noise_m = 0.001, .missing = 0.9, .frames = 40}, 1);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_EQ(errors->report.answered, 0);  // no two complete frames
  EXPECT_EQ(errors->report.frames, 40);
  EXPECT_FALSE(study_elbow({.missing = 2.0}, 1));
}

TEST(StudySleeve, ContinuityAnswersEveryFrame) {
  const auto errors = study_sleeve({.noise_m = 0.001, .hard = false, .duration_s = 4.0}, 1);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_EQ(errors->smoothed.share_answered(), 1.0);
  EXPECT_LT(errors->smoothed.rms_answered_m(), errors->alone.rms_determined_m() + 2e-4);
  EXPECT_LT(errors->alone.over_bound(), 1.3);
  EXPECT_GT(errors->report.share_answered(), 0.8)
      << "no frame shows all markers: it takes those that are complete";
  EXPECT_LT(errors->report.rms_answered_m(), 0.1);
  EXPECT_FALSE(study_sleeve({.duration_s = -1.0}, 1));
}

TEST(StudySleeve, SumsAddUp) {
  ElbowErrors elbow;
  elbow.ours.frames = 3;
  elbow += elbow;
  EXPECT_EQ(elbow.ours.frames, 6);
  SleeveErrors sleeve;
  sleeve.smoothed.frames = 2;
  sleeve += sleeve;
  EXPECT_EQ(sleeve.smoothed.frames, 4);
}

}  // namespace
}  // namespace kinemark::studies

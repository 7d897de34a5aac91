// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::simulation {
namespace {

using ::testing::HasSubstr;

TEST(SubjectOptions, DefaultsHold) { EXPECT_TRUE(SubjectOptions{}.check()); }

TEST(SubjectOptions, EveryRangeIsGuardedAndNamed) {
  const auto message = [](SubjectOptions o) {
    const auto status = o.check();
    EXPECT_FALSE(status);
    if (status) return std::string();
    EXPECT_EQ(status.error().code, Code::usage);
    return status.error().message;
  };
  EXPECT_THAT(message({.duration_s = 0.0}), HasSubstr("duration_s"));
  EXPECT_THAT(message({.duration_s = NAN}), HasSubstr("duration_s"));
  EXPECT_THAT(message({.rate_hz = -1.0}), HasSubstr("rate_hz"));
  EXPECT_THAT(message({.rate_hz = INFINITY}), HasSubstr("rate_hz"));
  EXPECT_THAT(message({.duration_s = 1e9, .rate_hz = 1e9}), HasSubstr("frames"));
  EXPECT_THAT(message({.duration_s = 1e-6, .rate_hz = 1.0}), HasSubstr("frames"));
  EXPECT_THAT(message({.full_turns = NAN}), HasSubstr("full_turns"));
  EXPECT_THAT(message({.noise_sd_m = -1e-9}), HasSubstr("noise_sd_m is -1e-09; expected 0 to 1"));
  EXPECT_THAT(message({.soft_tissue = 1.1}), HasSubstr("soft_tissue"));
  EXPECT_THAT(message({.soft_tissue_common = -0.1}), HasSubstr("soft_tissue_common"));
  EXPECT_THAT(message({.dropout_random = 0.95}), HasSubstr("dropout_random"));
  EXPECT_THAT(message({.dropout_sight = NAN}), HasSubstr("dropout_sight"));
  EXPECT_THAT(message({.threads = -1}), HasSubstr("threads"));
}

TEST(SubjectOptions, FramesAreRounded) {
  EXPECT_EQ((SubjectOptions{.duration_s = 10.0, .rate_hz = 100.0}.frames()), 1000);
  EXPECT_EQ((SubjectOptions{.duration_s = 1.0, .rate_hz = 59.94}.frames()), 60);
}

TEST(MotionKind, NamesComeBack) {
  for (const auto kind : {MotionKind::walk, MotionKind::reach, MotionKind::tai_chi, MotionKind::mixed})
    EXPECT_EQ(parse_motion_kind(to_string(kind)).value(), kind);
  const auto unknown = parse_motion_kind("swim");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "there is no motion 'swim'; there are walk, reach, tai-chi and mixed");
}

}  // namespace
}  // namespace kinemark::simulation

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/job_settings.h"

#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

TEST(Beside, KeepsFolderAndStem) {
  EXPECT_EQ(beside("a/b/Q.mot", "_sd.sto"), std::filesystem::path("a/b/Q_sd.sto"));
  EXPECT_EQ(beside("Q.v2.mot", "_x"), std::filesystem::path("Q.v2_x"));
}

TEST(EndingOf, IsInLowerCaseWithItsDot) {
  EXPECT_EQ(ending_of("a.b/Walk.C3D"), ".c3d");
  EXPECT_EQ(ending_of("walk.tar.Gz"), ".gz");
  EXPECT_EQ(ending_of("a.b/walk"), "");
  EXPECT_EQ(ending_of(""), "");
}

TEST(JobOutcome, OneMissedGateIsTheExitStatus) {
  JobOutcome outcome;
  EXPECT_EQ(outcome.exit_status(), 0) << "no gates";
  outcome.gates.push_back({.name = "a", .passed = true});
  outcome.warnings = {"warnings do not count"};
  EXPECT_EQ(outcome.exit_status(), 0);
  outcome.gates.push_back({.name = "b", .passed = false});
  outcome.gates.push_back({.name = "c", .passed = true});
  EXPECT_EQ(outcome.exit_status(), 1);
}

TEST(JobSettings, WorkWithoutBeingSet) {
  const JobSettings settings;
  EXPECT_EQ(settings.threads, 1);
  EXPECT_EQ(settings.seed, 1U);
  EXPECT_FALSE(settings.force);
  EXPECT_FALSE(settings.progress) << "nobody listens";
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "kinemark/pipeline/clean/internal/clean_account.h"

namespace kinemark::pipeline::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// What the account says of an option; "none" where it has no such.
std::string option_of(const CleanJob& job, const std::string& name) {
  const auto run = describe_run(job, {});
  const auto found = std::ranges::find(run.options, name, [](const auto& option) { return option.first; });
  return found == run.options.end() ? "none" : found->second;
}

TEST(CleanAccount, WhatIsFoundFromTheDataSaysSo) {
  CleanJob job;
  job.input = "walk.c3d";
  for (const char* name : {"order", "cut-off", "marker noise"})
    EXPECT_EQ(option_of(job, name), "found from the data") << name;
  job.filter.order = 4;
  job.filter.cutoff_hz = 6.5;
  job.filter.noise_sd_m = 3e-4;
  EXPECT_EQ(option_of(job, "order"), "4");
  EXPECT_EQ(option_of(job, "cut-off"), "6.5 Hz");
  EXPECT_EQ(option_of(job, "marker noise"), "0.3 mm");
  for (const char* name : {"order", "cut-off", "marker noise"})
    EXPECT_THAT(option_of(job, name), Not(HasSubstr("found from the data"))) << name;
}

TEST(CleanAccount, TheRuleOfACutOffIsThatOfButterworthAlone) {
  CleanJob job;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "none");
  job.filter.method = trajectory::FilterMethod::butterworth;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "yes");
  job.filter.correct_cutoff = false;
  EXPECT_EQ(option_of(job, "cut-off of both passes together"), "no");
}

}  // namespace
}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <span>

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

TEST(CleanAccount, SamplesThatTheRecorderMadeAreHandledAsAsked) {
  const auto done = [](workflow::RecorderMade made, int factor) {
    data::UpsamplingAccount account;
    account.recording.factor = factor;
    settle_upsampling(made, account);
    EXPECT_EQ(account.handled, factor > 1 && made != workflow::RecorderMade::keep);
    return account.done;
  };
  EXPECT_EQ(done(workflow::RecorderMade::keep, 2), "left as they are");
  EXPECT_EQ(done(workflow::RecorderMade::mark, 2), "marked as upsampled");
  EXPECT_THAT(done(workflow::RecorderMade::mark, 2), Not(HasSubstr("left as they are")));
  EXPECT_EQ(done(workflow::RecorderMade::missing, 3), "removed");
  EXPECT_EQ(done(workflow::RecorderMade::decimate, 3), "removed, and the rate brought down");
  EXPECT_THAT(done(workflow::RecorderMade::missing, 3), Not(HasSubstr("removed, and the rate brought down")));
  EXPECT_EQ(done(workflow::RecorderMade::mark, 1), "") << "none were made";
}

TEST(CleanAccount, WhatWasDoneAboutADefectIsWhatScreeningDid) {
  const std::vector<data::Finding> found = {
      {.kind = data::FindingKind::label_swap, .subject = "A", .partner = "B", .first_frame = 5},
      {.kind = data::FindingKind::label_swap, .subject = "A", .partner = "B", .first_frame = 9},
      {.kind = data::FindingKind::spike, .subject = "A", .first_frame = 5},
      {.kind = data::FindingKind::spike, .subject = "C", .first_frame = 5}};
  const auto settled = settle_defects(found, std::span(found).first(1), std::span(found).subspan(2, 1));
  ASSERT_EQ(settled.size(), 4U);
  const std::vector<std::string> done = {settled[0].done, settled[1].done, settled[2].done, settled[3].done};
  EXPECT_EQ(done, (std::vector<std::string>{"exchanged back", "left as it is", "rejected", "left as it is"}));
  for (const auto& one : settled) EXPECT_EQ(one.handled, one.done != "left as it is");
  EXPECT_THAT(done[1], Not(HasSubstr("exchanged back")));
  EXPECT_THAT(done[0], Not(HasSubstr("left as it is")));
  EXPECT_THAT(done[3], Not(HasSubstr("rejected")));
}

}  // namespace
}  // namespace kinemark::pipeline::internal

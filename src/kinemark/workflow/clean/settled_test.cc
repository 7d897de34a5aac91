// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <span>
#include <string>
#include <vector>

#include "kinemark/workflow/clean/internal/settled.h"

namespace kinemark::workflow::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Settled, SamplesThatTheRecorderMadeAreHandledAsAsked) {
  const auto done = [](RecorderMade made, int factor) {
    data::UpsamplingAccount account;
    account.recording.factor = factor;
    settle_upsampling(made, account);
    EXPECT_EQ(account.handled, factor > 1 && made != RecorderMade::keep);
    return account.done;
  };
  EXPECT_EQ(done(RecorderMade::keep, 2), "left as they are");
  EXPECT_EQ(done(RecorderMade::mark, 2), "marked as upsampled");
  EXPECT_THAT(done(RecorderMade::mark, 2), Not(HasSubstr("left as they are")));
  EXPECT_EQ(done(RecorderMade::missing, 3), "removed");
  EXPECT_EQ(done(RecorderMade::decimate, 3), "removed, and the rate brought down");
  EXPECT_THAT(done(RecorderMade::missing, 3), Not(HasSubstr("removed, and the rate brought down")));
  EXPECT_EQ(done(RecorderMade::mark, 1), "") << "none were made";
}

TEST(Settled, WhatWasDoneAboutADefectIsWhatScreeningDid) {
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
}  // namespace kinemark::workflow::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/event_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/trajectory/edits/testing/edited.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Edit;
using ::testing::HasSubstr;
using testing::moving_trial;
using ::testing::Not;

Edit event(double time_s, double to_s = 0.0) {
  return {.label = "Foot Strike", .context = "Left", .time_s = time_s, .to_s = to_s};
}

std::string why_not(Status (*verb)(data::Trial&, const Edit&), const Edit& edit) {
  auto trial = moving_trial();
  const auto s = verb(trial, edit);
  EXPECT_FALSE(s);
  EXPECT_EQ(testing::bytes_of(trial), testing::bytes_of(moving_trial())) << "a refusal changes nothing";
  return s ? "" : s.error().message;
}

TEST(EventEdits, MarkMoveDelete) {
  auto trial = moving_trial();
  ASSERT_TRUE(mark_event(trial, event(6.0)));
  ASSERT_EQ(trial.events.size(), 3U);
  EXPECT_EQ(trial.events[2].label, "Foot Strike");
  EXPECT_EQ(trial.events[2].context, "Left");
  EXPECT_EQ(trial.events[2].time_s, 6.0);
  ASSERT_TRUE(move_event(trial, event(5.4, 5.5)));
  EXPECT_EQ(trial.events[0].time_s, 5.5);
  ASSERT_TRUE(delete_event(trial, event(6.0)));
  EXPECT_EQ(trial.events.size(), 2U);
  EXPECT_EQ(trial.events[1].label, "Foot Off");
}

TEST(EventEdits, TheOneWithinHalfAFrameIsMeant) {
  auto trial = moving_trial();
  trial.events.push_back({.label = "Foot Strike", .context = "Left", .time_s = 5.402});
  ASSERT_TRUE(delete_event(trial, event(5.4045)));
  EXPECT_EQ(trial.events.size(), 2U);
  EXPECT_EQ(trial.events[0].time_s, 5.4) << "the nearest of two";
  ASSERT_TRUE(move_event(trial, event(5.4, 5.401))) << "it does not stand in its own way";
}

TEST(EventEdits, WhatIsNotThereOrCannotBeIsSaid) {
  EXPECT_THAT(why_not(delete_event, event(5.41)),
              HasSubstr("no event 'Foot Strike' (Left) is at 5.41 s; the nearest of that name is at 5.4 s"));
  EXPECT_THAT(why_not(delete_event, {.label = "Foot Strike", .time_s = 5.4}),
              HasSubstr("no event 'Foot Strike' is at 5.4 s; there is none of that name"));
  EXPECT_THAT(why_not(delete_event, event(5.41)), Not(HasSubstr("there is none of that name")));
  EXPECT_THAT(why_not(delete_event, {.label = "Foot Strike", .time_s = 5.4}),
              Not(HasSubstr("the nearest of that name is at")));
  EXPECT_THAT(why_not(move_event, event(5.4, 7.1)),
              HasSubstr("7.1 s lies outside the recording, which lasts from 5 to 6.99 s"));
  EXPECT_THAT(why_not(mark_event, event(4.9)), HasSubstr("lies outside"));
  EXPECT_THAT(why_not(mark_event, event(5.404)), HasSubstr("is at 5.4 s already"));
}

TEST(EventEdits, TheEndsOfTheRecordingBelongToIt) {
  auto trial = moving_trial();
  EXPECT_TRUE(mark_event(trial, event(4.995)));
  EXPECT_TRUE(mark_event(trial, event(6.995)));
  EXPECT_FALSE(mark_event(trial, event(6.999)));
}

}  // namespace
}  // namespace kinemark::trajectory::internal

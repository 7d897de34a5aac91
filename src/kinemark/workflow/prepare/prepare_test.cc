// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/prepare.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>

#include "kinemark/stages/motion/foundations/testing/walking_body.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::workflow {
namespace {

using data::EditKind;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A recording with a force on each frame that grows by 1 N a frame.
data::Recording walk() {
  data::Recording walk{.trial = trajectory::testing::moving_trial()};
  const auto& time = walk.trial.markers.time;
  const auto zeros = Array<double>(static_cast<std::size_t>(3 * time.frames), 0.0);
  data::Wrench plate{.name = "plate 1", .body = "", .force = zeros, .moment = zeros, .point = zeros};
  for (std::int64_t f = 0; f < time.frames; ++f)
    plate.force[static_cast<std::size_t>(3 * f + 2)] = static_cast<double>(f);
  walk.plates = data::Wrenches{.time = time, .items = {plate}};
  return walk;
}

Vector3d force_at(const data::Recording& recording, std::size_t frame) {
  return Vector3d(&recording.plates->items[0].force[3 * frame]);
}

TEST(Prepare, WithoutOptionsAllStaysAsItIs) {
  const auto before = walk();
  const auto after = prepare(before);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(trajectory::testing::bytes_of(after->trial), trajectory::testing::bytes_of(before.trial));
  EXPECT_THAT(after->notes, IsEmpty());
  EXPECT_FALSE(after->up);
}

TEST(Prepare, EditsComeFirstThenNamesThenAxes) {
  PrepareOptions options;
  options.edits = {{.kind = EditKind::swap, .marker = "LKNE", .other = "RKNE"},
                   {.kind = EditKind::cut, .marker = "SACR"},
                   {.kind = EditKind::undo},
                   {.kind = EditKind::region, .first_frame = 520, .last_frame = 530, .name = "gait"}};
  options.selection.select = {"LKNE"};
  options.axes.rotate = "x 90";
  const auto before = walk();
  const auto after = prepare(before, options);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_THAT(after->trial.markers.names, ElementsAre("LKNE"));
  EXPECT_EQ(after->edits.in_force, 2U);
  EXPECT_THAT(after->edits.swapped, ElementsAre(std::pair<std::string, std::string>("LKNE", "RKNE")));
  EXPECT_EQ(after->edits.regions.front().name, "gait");
  const auto& names = before.trial.markers.names;
  const auto from = std::ranges::find(names, "RKNE") - names.begin();
  const Vector3d was = before.trial.markers.x(20, from);
  EXPECT_EQ(after->trial.markers.x(20, 0), Vector3d(was.x(), -was.z(), was.y()));
  EXPECT_EQ(force_at(*after, 20), Vector3d(0.0, -20.0, 0.0));
  EXPECT_THAT(after->notes, ElementsAre(HasSubstr("the recording was turned: x 90")));
}

TEST(Prepare, ForcesStandOnTheFramesThatAreLeft) {
  PrepareOptions options;
  const auto before = walk();
  const auto first = before.trial.first_frame + 10;
  options.selection.frames = std::to_string(first) + "-" + std::to_string(first + 4);
  const auto after = prepare(before, options);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->plates->time, after->trial.markers.time);
  ASSERT_EQ(after->plates->items[0].force.size(), 15U);
  EXPECT_NEAR(force_at(*after, 0).z(), 10.0, 1e-9);
}

TEST(Prepare, WhoStatesTheVerticalIsHeard) {
  PrepareOptions options;
  options.axes.up = "y";
  const auto after = prepare(walk(), options);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->up, Vector3d::UnitY());
  EXPECT_EQ(stated_vertical(options.axes)->up, Vector3d::UnitY());
  EXPECT_FALSE(stated_vertical({.up = "auto"}));
  EXPECT_FALSE(stated_vertical({}));
}

TEST(Prepare, ABodyOfNobodysSizeIsSaid) {
  const std::vector<std::string> names = {"LASI", "RASI", "LPSI", "RPSI", "LKNE", "LANK", "LHEE", "LTOE",
                                          "RKNE", "RANK", "RHEE", "RTOE", "LTHI", "RTHI", "LTIB", "RTIB"};
  data::Recording walk;
  walk.trial.markers = motion::testing::walking_body(names, 30);
  for (const char* absent : {"the unit of length is another one, or this is no human body"})
    EXPECT_THAT(prepare(walk).value().notes, Not(Contains(HasSubstr(absent))));
  for (double& x : walk.trial.markers.x_in_world) x *= 10.0;
  EXPECT_THAT(prepare(walk).value().notes,
              ElementsAre(HasSubstr("the unit of length is another one, or this is no human body")));
}

TEST(Prepare, WhatCannotBeDoneIsRefused) {
  PrepareOptions options;
  options.axes.up = "w";
  EXPECT_EQ(prepare(walk(), options).error().code, Code::usage);
  options.axes = {};
  options.edits = {{.kind = EditKind::cut, .marker = "NOBODY"}};
  EXPECT_EQ(prepare(walk(), options).error().code, Code::bad_input);
  options.edits = {{.kind = EditKind::undo}};
  EXPECT_EQ(prepare(walk(), options).error().code, Code::bad_input) << "there is nothing to undo";
  options.edits = {};
  options.selection.select = {"NOBODY"};
  EXPECT_THAT(prepare(walk(), options).error().message, HasSubstr("NOBODY"));
}

}  // namespace
}  // namespace kinemark::workflow

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/screen_axes.h"

#include <gtest/gtest.h>

#include "kinemark/io/markers/marker_file.h"
#include "support/scratch.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;

TEST(ScreenAxes, LettersAreThoseOfAC3dFile) {
  EXPECT_EQ(letters_of_axis(Vector3d::UnitZ()), "+Z");
  EXPECT_EQ(letters_of_axis(-Vector3d::UnitX()), "-X");
  EXPECT_EQ(letters_of_axis({0.6, 0.8, 0.0}), "");
}

TEST(ScreenAxes, ARecordingThatSaysNothingHasNone) {
  data::Trial trial;
  EXPECT_FALSE(screen_up(trial));
  trial.foreign.push_back({.name = "POINT", .description = {}, .parameters = {}});
  EXPECT_FALSE(screen_up(trial));
}

TEST(ScreenAxes, WhatIsSetIsReadAndReplacesWhatWasSaid) {
  data::Trial trial;
  set_screen_up(trial, Vector3d::UnitZ());
  EXPECT_EQ(screen_up(trial), Vector3d::UnitZ());
  set_screen_up(trial, -Vector3d::UnitY());
  EXPECT_EQ(screen_up(trial), Vector3d(0.0, -1.0, 0.0));
  ASSERT_EQ(trial.foreign.size(), 1U);
  EXPECT_EQ(trial.foreign[0].parameters.size(), 2U);
}

TEST(ScreenAxes, AFileKeepsThem) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 4});
  set_screen_up(trial, Vector3d::UnitX());
  ASSERT_TRUE(io::write_markers(scratch / "a.c3d", trial, false));
  EXPECT_EQ(screen_up(io::read_markers(scratch / "a.c3d").value()), Vector3d::UnitX());
}

}  // namespace
}  // namespace kinemark::workflow

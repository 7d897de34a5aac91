// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/rig_scenes.h"

#include <gmock/gmock.h>

#include <cmath>

namespace kinemark::pipeline {
namespace {

TEST(RigScenes, HaveTheirStreamsOfNoise) {
  EXPECT_EQ(stage_tree(3)->stream, 303U);
  EXPECT_EQ(stage_wheel({})->stream, 400U);
  EXPECT_EQ(stage_wheel({.rotation_deg = 35.0})->stream, 401U);
  EXPECT_EQ(stage_sign().stream, 420U);
  EXPECT_EQ(stage_wheel({.leds = 8})->scene.leds.size(), 8U);
}

TEST(RigScenes, RefusePosesAndTurnsThatAreNone) {
  EXPECT_FALSE(stage_tree(10));
  EXPECT_FALSE(stage_tree(-1));
  EXPECT_FALSE(stage_wheel({.rotation_deg = std::nan("")}));
}

}  // namespace
}  // namespace kinemark::pipeline

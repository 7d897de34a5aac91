// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/position_name.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

TEST(PositionName, WhatIsMeasuredOtherwiseSaysSo) {
  for (const char* name : {"acc", "Acc", "wrist_force", "Angular velocity", "pelvis.rot", "Gyroscope", "GRF",
                           "quat", "magnetometer", "sensor 1 accel", "left-angles", "orientation", "FORCES",
                           "LHipAngles", "RGroundReactionForce", "LKneeMoment", "F"})
    EXPECT_TRUE(names_no_position(name)) << name;
}

TEST(PositionName, MarkersDoNot) {
  for (const char* name : {"LASI", "", "hand", "R.Shoulder", "accent", "forceps", "RMAG1", "position",
                           "Marcel", "M1", "triangle", "M", "forcep"})
    EXPECT_FALSE(names_no_position(name)) << name;
}

}  // namespace
}  // namespace kinemark::io

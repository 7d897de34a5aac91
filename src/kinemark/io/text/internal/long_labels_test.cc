// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/long_labels.h"

#include <gtest/gtest.h>

namespace kinemark::io::internal {
namespace {

TEST(LongLabels, AreKnownInOtherWords) {
  const auto labels = long_labels({"Frame", "Time (ms)", "Name", "X (mm)", "Y (mm)", "Z (mm)", "score"});
  EXPECT_TRUE(labels.is_whole());
  EXPECT_EQ(labels.frame, 0U);
  EXPECT_EQ(labels.time, 1U);
  EXPECT_EQ(labels.units_per_second, 1000.0);
  EXPECT_EQ(labels.marker, 2U);
  EXPECT_EQ(labels.coordinate[2], 5U);
  EXPECT_EQ(labels.unit, "mm");
  const auto other = long_labels({"bodypart", "pos_z", "pos_y", "pos_x", "t"});
  EXPECT_TRUE(other.is_whole());
  EXPECT_FALSE(other.frame);
  EXPECT_EQ(other.coordinate[0], 3U);
  EXPECT_EQ(other.unit, "");
}

TEST(LongLabels, WhatIsNotThereIsNotMade) {
  EXPECT_FALSE(long_labels({"Frame", "Name", "X", "Y", "Z"}).is_whole()) << "no time";
  EXPECT_FALSE(long_labels({"t", "Name", "X", "Y"}).is_whole()) << "two dimensions";
  EXPECT_FALSE(long_labels({"t", "A_X", "A_Y", "A_Z"}).is_whole()) << "a wide table";
  EXPECT_FALSE(long_labels({}).is_whole());
}

}  // namespace
}  // namespace kinemark::io::internal

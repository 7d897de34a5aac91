// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/arrays/named_arrays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

NamedArray text(std::string name, std::vector<std::string> texts) {
  NamedArray out{.name = std::move(name), .texts = std::move(texts), .is_text = true};
  if (out.texts.size() > 1) out.shape = {std::ssize(out.texts)};
  return out;
}

NamedArray one(std::string name, double value) { return {.name = std::move(name), .numbers = {value}}; }

/// Numbers 0, 1, 2, ... of a shape.
NamedArray counting(std::string name, std::vector<std::int64_t> shape) {
  NamedArray out{.name = std::move(name), .shape = std::move(shape)};
  for (std::int64_t i = 0; i < out.size(); ++i) out.numbers.push_back(static_cast<double>(i));
  return out;
}

TEST(NamedArrays, APathForEachMarkerInEitherOrder) {
  const auto trial = trial_of_arrays(
      {counting("hand", {5, 3}), counting("elbow", {3, 5}), one("fs", 50.0), text("unit", {"mm"})}, "");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("hand", "elbow"));
  EXPECT_EQ(trial->markers.frames(), 5);
  EXPECT_EQ(trial->markers.time.rate_hz, 50.0);
  EXPECT_LT((trial->markers.x(1, 0) - Vector3d(0.003, 0.004, 0.005)).norm(), 1e-12);
  EXPECT_LT((trial->markers.x(1, 1) - Vector3d(0.001, 0.006, 0.011)).norm(), 1e-12) << "3 x frames";
  EXPECT_THAT(trial->warnings, IsEmpty());
}

TEST(NamedArrays, RowsOfAllMarkersByTheirNames) {
  const auto trial = trial_of_arrays(
      {counting("data", {4, 6}), text("labels", {"A", "B"}), one("rate", 100.0), text("units", {"m"})}, "");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(trial->markers.x(1, 1), Vector3d(9.0, 10.0, 11.0));
}

TEST(NamedArrays, WhatIsMeasuredOtherwiseIsNoMarker) {
  const auto trial = trial_of_arrays(
      {counting("hand", {5, 3}), counting("hand_force", {5, 3}), counting("acc", {5, 3}), one("fs", 50.0)},
      "mm");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("hand"));
  EXPECT_THAT(trial->warnings,
              ElementsAre(HasSubstr("2 of 4 arrays are no positions, names or times and are not "
                                    "read: hand_force (5 x 3), acc (5 x 3)")));
}

TEST(NamedArrays, WithoutPositionsOrAClockItIsSaidWhatIsThere) {
  const auto none = trial_of_arrays({one("fs", 50.0)}, "");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no positions are found: holds fs (one value); expected"));
  const auto clock = trial_of_arrays({counting("hand", {5, 3})}, "mm");
  ASSERT_FALSE(clock);
  EXPECT_THAT(clock.error().message, HasSubstr("no clock is found: holds hand (5 x 3)"));
}

}  // namespace
}  // namespace kinemark::io

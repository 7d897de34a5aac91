// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples that give themselves away without a model, and some that only seem to.
#include "kinemark/stages/motion/internal/judged_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kSlowFrames = 100;

class PlainDefects : public ::testing::Test {
 protected:
  PlainDefects()
      : body(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(body, kSlowFrames, 0.5e-3, 3)) {}

  [[nodiscard]] std::vector<Outlier> find() const {
    const Problem problem = make_problem(body, markers, options).value();
    SolvedFrames solved;
    EXPECT_TRUE(FrameWalk(problem, options, {}).run(markers, true, solved));
    return find_plain_defects(problem, markers, solved);
  }
  void hold(std::int64_t marker, std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first + 1; f <= last; ++f) markers.x(f, marker) = markers.x(first, marker);
  }
  /// Every marker goes on as between frames 30 and 31, by so much of that step a frame.
  void slow_down(double share) {
    const auto fast = markers;
    for (std::int64_t f = 0; f < kSlowFrames; ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        markers.x(f, m) = fast.x(30, m) + (fast.x(31, m) - fast.x(30, m)) * share * static_cast<double>(f);
  }
  void keep_digits(double digit_m) {
    for (std::int64_t f = 0; f < kSlowFrames; ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        for (double& value : markers.x(f, m)) value = digit_m * std::round(value / digit_m);
  }

  IkOptions options;
  model::Model body;
  data::Trajectories markers;
};

TEST_F(PlainDefects, AValueHeldWhileTheBodyHardlyMovesIsFound) {
  slow_down(0.05);
  ASSERT_LT((markers.x(47, 7) - markers.x(40, 7)).norm(), 2e-3);
  hold(7, 40, 47);
  const auto found = find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].why, Outlier::Why::held);
  EXPECT_EQ(found[0].first_frame, 41);
  EXPECT_EQ(found[0].last_frame, 47);
}

TEST_F(PlainDefects, ACoarseRecordingRepeatsItselfWithoutBeingHeld) {
  // Whole millimetres, a slow movement: values repeat for many frames.
  slow_down(0.02);
  keep_digits(1e-3);
  std::int64_t repeats = 0;
  for (std::int64_t f = 2; f < kSlowFrames; ++f)
    repeats += markers.x(f, 7) == markers.x(f - 1, 7) && markers.x(f, 7) == markers.x(f - 2, 7);
  ASSERT_GT(repeats, 0);
  EXPECT_TRUE(find().empty());
}

}  // namespace
}  // namespace kinemark::motion::internal

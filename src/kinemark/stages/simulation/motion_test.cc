// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/state.h"
#include "kinemark/stages/simulation/testing/models.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::VectorXd;

constexpr MotionKind kMotions[] = {MotionKind::walk, MotionKind::reach, MotionKind::tai_chi,
                                   MotionKind::mixed};

const data::CoordinateDescription& described(const model::Model& model, int c) {
  return model.description().coordinates[static_cast<std::size_t>(c)];
}

/// Index of a coordinate's own state, or -1.
int own_state(const model::Model& model, int c) {
  return model.coordinates()[static_cast<std::size_t>(c)].state_idx;
}

TEST(Motion, StaysWithinTheRangesAtAnyTimeAndNeedsThem) {
  for (const MotionKind kind : kMotions)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Motion motion(human(), {.motion = kind, .duration_s = 60.0, .seed = seed});
      VectorXd low = motion.state(0.0), high = low;
      for (int i = 1; i < 600; ++i) {
        const VectorXd x = motion.state(0.1 * i);
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      for (int c = 0; c < human().coordinate_count(); ++c) {
        const int i = own_state(human(), c);
        const auto& d = described(human(), c);
        if (i < 0) continue;
        if (d.locked) {
          EXPECT_EQ(low[i], high[i]) << d.name;
          EXPECT_EQ(low[i], d.default_value) << d.name;
        } else {
          EXPECT_GT(high[i] - low[i], 1e-3) << d.name << " moves";
          EXPECT_GE(low[i], d.clamped ? d.range_min : -10.0) << d.name;
          EXPECT_LE(high[i], d.clamped ? d.range_max : 10.0) << d.name;
        }
      }
    }
}

TEST(Motion, AWalkOnTheSpotComesBackAfterAStride) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Motion motion(human(), {.motion = MotionKind::walk, .duration_s = 20.0, .seed = seed});
    EXPECT_GE(motion.stride_hz(), 0.8);
    EXPECT_LE(motion.stride_hz(), 1.05);
    for (const double t : {0.0, 0.37, 5.1}) {
      const VectorXd here = motion.state(t), later = motion.state(t + 1.0 / motion.stride_hz());
      VectorXd way(human().speed_count());
      model::difference(human(), here, later, way);
      EXPECT_LT(way.norm(), 1e-9) << seed << " " << t;
      model::difference(human(), here, motion.state(t + 0.3 / motion.stride_hz()), way);
      EXPECT_GT(way.norm(), 0.05) << "and not before";
    }
  }
}

TEST(Motion, TheLeftSideFollowsTheRightHalfAStrideLater) {
  const Motion motion(human(), {.motion = MotionKind::walk, .duration_s = 20.0, .seed = 3});
  int pairs = 0;
  for (int left = 0; left < human().coordinate_count(); ++left) {
    const auto& d = described(human(), left);
    if (!d.name.ends_with("_l") || !d.clamped || d.locked) continue;
    const int right = human().description().find_coordinate(d.name.substr(0, d.name.size() - 2) + "_r");
    if (right < 0 || own_state(human(), left) < 0 || own_state(human(), right) < 0) continue;
    const auto& other = described(human(), right);
    if (other.range_min != d.range_min || other.range_max != d.range_max) continue;
    ++pairs;
    for (const double t : {0.0, 0.41, 3.3})
      EXPECT_NEAR(motion.state(t)[own_state(human(), left)],
                  motion.state(t + 0.5 / motion.stride_hz())[own_state(human(), right)], 1e-9)
          << d.name;
  }
  EXPECT_GE(pairs, 5);
}

TEST(Motion, ATurnIsAboutTheVerticalAndComesRound) {
  // With and without a turn the rest of the motion is the same: only the heading is added.
  for (const double turns : {1.0, -2.0, 0.25}) {
    const Motion straight(human(), {.motion = MotionKind::reach, .duration_s = 8.0, .seed = 2});
    const Motion turning(human(),
                         {.motion = MotionKind::reach, .duration_s = 8.0, .seed = 2, .full_turns = turns});
    ASSERT_EQ(human().free_joints().size(), 1U);
    const int root = human().free_joints()[0].state_idx;
    const auto attitude = [&](const VectorXd& x) {
      return Eigen::Quaterniond(x[root + 3], x[root + 4], x[root + 5], x[root + 6]);
    };
    for (const double t : {0.0, 2.0, 5.0, 8.0}) {
      const VectorXd a = straight.state(t), b = turning.state(t);
      const double heading = 2.0 * M_PI * turns * t / 8.0;
      const double angle = attitude(a).angularDistance(attitude(b));
      EXPECT_NEAR(angle, std::abs(std::remainder(heading, 2.0 * M_PI)), 1e-9) << turns << " " << t;
      VectorXd rest_a = a, rest_b = b;
      rest_a.segment<7>(root).setZero();
      rest_b.segment<7>(root).setZero();
      EXPECT_EQ(rest_a, rest_b);
    }
  }
}

TEST(Motion, AModelWithoutARootMovesItsJointsOnly) {
  const auto arm = model::Model::compile(small_arm()).value();
  const Motion motion(arm, {.motion = MotionKind::mixed, .duration_s = 5.0, .full_turns = 3.0});
  for (const double t : {0.0, 1.0, 4.9}) {
    const VectorXd x = motion.state(t);
    EXPECT_EQ(x.size(), arm.state_count());
    EXPECT_TRUE(x.allFinite());
    EXPECT_EQ(x[own_state(arm, 2)], 0.02) << "the slide is locked";
  }
}

TEST(Wave, IsItsCentreAndItsSines) {
  const Wave wave{.centre = 2.0, .sines = {{1.0, 0.5, 0.0}, {0.25, 2.0, M_PI / 2.0}}};
  EXPECT_DOUBLE_EQ(wave(0.0), 2.25);
  EXPECT_NEAR(wave(0.5), 3.25, 1e-12);
  EXPECT_NEAR(wave(2.0), wave(0.0), 1e-12) << "the period of both";
  EXPECT_EQ(Wave{.centre = -1.0}(7.0), -1.0);
}

}  // namespace
}  // namespace kinemark::simulation::internal

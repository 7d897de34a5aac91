// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/internal/unmeasured_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using ::testing::IsEmpty;

constexpr double kMass = 70.0, kRate = 100.0, kWeight = kMass * 9.81;
const Vector3d kGravity(0.0, -9.81, 0.0);

/// Someone who walks along x: the left foot stands at 0 m from frame 0 to 59, the right one at 0.7 m from
/// frame 50 to 110, and load passes from one to the other in frames 50 to 59.
class Walk {
 public:
  static constexpr std::int64_t kFrames = 120;

  [[nodiscard]] static double load_n(int foot, std::int64_t f) {
    const double to_right = std::clamp((static_cast<double>(f) - 50.0) / 10.0, 0.0, 1.0);
    if (foot == 1) return f > 110 ? 0.0 : to_right * kWeight;
    return (1.0 - to_right) * kWeight;
  }
  [[nodiscard]] static Vector3d position(int foot, std::int64_t f) {
    const auto t = static_cast<double>(f);
    if (foot == 0) return {f < 60 ? 0.0 : 0.02 * (t - 59.0), f < 60 ? 0.05 : 0.12, -0.1};
    return {f < 50    ? 0.7 - 0.02 * (50.0 - t)
            : f > 110 ? 0.7 + 0.02 * (t - 110.0)
                      : 0.7,
            f < 50 || f > 110 ? 0.12 : 0.05, 0.1};
  }

  /// The residual where `measured[foot]` stand on plates that carry them, with scatter.
  [[nodiscard]] static std::vector<RootFrame> frames(std::array<bool, 2> measured, double scatter_n = 3.0) {
    Random random(3, 7);
    std::vector<RootFrame> out;
    for (std::int64_t f = 0; f < kFrames; ++f) {
      RootFrame frame{.force = scatter_n * Vector3d(random.gaussian(), random.gaussian(), random.gaussian()),
                      .moment = Vector3d::Zero(),
                      .origin = {0.0058 * static_cast<double>(f), 1.0, 0.0},
                      .centre = {0.0058 * static_cast<double>(f), 1.0, 0.0},
                      .feet = {},
                      .on_plate = {}};
      for (int foot = 0; foot < 2; ++foot) {
        frame.feet.push_back(position(foot, f));
        frame.on_plate.push_back(measured[static_cast<std::size_t>(foot)] && load_n(foot, f) > 20.0);
        if (measured[static_cast<std::size_t>(foot)]) continue;
        const Vector3d force(0.05 * load_n(foot, f), load_n(foot, f), 0.0);
        const Vector3d sole = position(foot, f) + Vector3d(0.05, -0.05, 0.01);
        frame.force += force;
        frame.moment += (sole - frame.origin).cross(force);
      }
      out.push_back(frame);
    }
    return out;
  }
};

std::vector<UnmeasuredLoad> find(const std::vector<RootFrame>& frames) {
  return find_unmeasured_load(frames, kGravity, kMass, 20.0, kRate);
}

TEST(UnmeasuredLoad, IsFoundFromHeelStrikeToToeOff) {
  const auto found = find(Walk::frames({true, false}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].foot, 1);
  EXPECT_NEAR(static_cast<double>(found[0].first_frame), 51.0, 1.0)
      << "3 % of the weight are borne in frame 51";
  EXPECT_EQ(found[0].last_frame, 110);
  EXPECT_NEAR(found[0].force_max_n, kWeight, 20.0);
}

TEST(UnmeasuredLoad, NothingIsSaidWherePlatesCarryEverything) {
  EXPECT_THAT(find(Walk::frames({true, true})), IsEmpty());
  EXPECT_THAT(find(Walk::frames({true, true}, 25.0)), IsEmpty()) << "accelerations from noisy markers";
}

TEST(UnmeasuredLoad, EachFootHasItsOwnStretch) {
  const auto found = find(Walk::frames({false, false}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].foot, 0);
  EXPECT_EQ(found[0].first_frame, 0);
  EXPECT_GE(found[0].last_frame, 57);
  EXPECT_EQ(found[1].foot, 1);
  EXPECT_LE(found[1].first_frame, 52);
  EXPECT_EQ(found[1].last_frame, 110);
}

TEST(UnmeasuredLoad, AFootOnTheEdgeOfAPlateIsFoundWhereMuchIsMissing) {
  for (const double missing : {0.15, 0.6}) {
    auto frames = Walk::frames({true, true}, 1.0);
    for (std::int64_t f = 5; f < 45; ++f) {
      auto& frame = frames[static_cast<std::size_t>(f)];
      const Vector3d force(0.0, missing * kWeight, 0.0);
      frame.force += force;
      frame.moment += (Walk::position(0, f) + Vector3d(0.08, -0.05, 0.0) - frame.origin).cross(force);
    }
    const auto found = find(frames);
    if (missing < 0.25) {
      EXPECT_THAT(found, IsEmpty()) << "as likely a wrong mass";
      continue;
    }
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].foot, 0);
    EXPECT_EQ(found[0].first_frame, 5);
    EXPECT_EQ(found[0].last_frame, 44);
  }
}

TEST(UnmeasuredLoad, OnATreadmillAFootStandsWhileItMoves) {
  auto frames = Walk::frames({true, false});
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Vector3d belt(-0.015 * static_cast<double>(f), 0.0, 0.0);  // 1.5 m/s
    frames[f].origin += belt;
    for (auto& foot : frames[f].feet) foot += belt;
    frames[f].on_plate[0] = f < 60;
  }
  const auto found = find(frames);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].foot, 1);
}

TEST(UnmeasuredLoad, AHandOnARailIsNoFoot) {
  auto frames = Walk::frames({true, true});
  for (auto& frame : frames) {
    const Vector3d force(0.0, 0.3 * kWeight, 0.0);
    frame.force += force;
    frame.moment += (Vector3d(0.3, 1.0, 1.2) - frame.origin).cross(force);
  }
  EXPECT_THAT(find(frames), IsEmpty());
}

TEST(UnmeasuredLoad, UnknownAndDownwardForcesAreNoLoad) {
  auto frames = Walk::frames({true, false});
  for (auto& frame : frames) frame.force = -frame.force;
  EXPECT_THAT(find(frames), IsEmpty());
  for (auto& frame : frames) frame.force = frame.moment = Vector3d::Constant(kNaN);
  EXPECT_THAT(find(frames), IsEmpty());
  EXPECT_THAT(find({}), IsEmpty());
  EXPECT_THAT(find_unmeasured_load(Walk::frames({true, false}), Vector3d::Zero(), kMass, 20.0, kRate),
              IsEmpty())
      << "without gravity nothing says what is up";
}

TEST(UnmeasuredLoad, ALimbIsWhatLiesBetweenFootAndRootAndWhatItCarries) {
  const auto model = model::Model::compile(testing_body::description()).value();
  for (int body = 0; body < static_cast<int>(model.bodies().size()); ++body)
    for (const int c : limb_coordinates(model, body)) {
      EXPECT_LT(model.coordinates()[static_cast<std::size_t>(c)].free_joint, 0) << "the root's stay";
      EXPECT_GE(model.coordinates()[static_cast<std::size_t>(c)].speed_idx, 0);
    }
  EXPECT_THAT(limb_coordinates(model, model.free_joints()[0].body).size(), 6U)
      << "all that the trunk carries";
}

}  // namespace
}  // namespace kinemark::motion::internal

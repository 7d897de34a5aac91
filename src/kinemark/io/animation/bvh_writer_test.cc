// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is written reads back: bodies where they were, whatever their tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinemark/core/random.h"
#include "kinemark/io/animation/bvh.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::Not;

/// Bodies that turn at random; those with an odd index are also moved in the one above.
PoseTree random_motion(const std::vector<int>& parents, std::int64_t frames, std::uint64_t seed) {
  Random random(seed, 2);
  const auto any = [&](double size) {
    return Vector3d(size * random.gaussian(), size * random.gaussian(), size * random.gaussian());
  };
  PoseTree out{.bodies = {}, .time = {.rate_hz = 60.0, .frames = frames}, .world_from_body = {}};
  std::vector<Vector3d> offsets;
  for (std::size_t b = 0; b < parents.size(); ++b) {
    out.bodies.push_back(
        {.name = "body " + std::to_string(b), .parent = parents[b], .end_in_body = {0, 0.8, 0}});
    offsets.push_back(any(0.3));
  }
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::size_t b = 0; b < parents.size(); ++b) {
      math::SE3 local{
          Eigen::Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
              .normalized()
              .toRotationMatrix(),
          offsets[b]};
      if (b % 2 == 1 || parents[b] < 0) local.translation += any(0.1);
      out.world_from_body.push_back(
          parents[b] < 0 ? local : out.pose(f, static_cast<std::size_t>(parents[b])) * local);
    }
  return out;
}

class WriteBvh : public ::testing::Test {
 protected:
  data::Trial written(const PoseTree& poses) {
    const auto status = write_bvh(scratch_ / "a.bvh", poses, true);
    EXPECT_TRUE(status) << status.error().message;
    return read_bvh(scratch_ / "a.bvh").value();
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(WriteBvh, BodiesReadBackWhereTheyWere) {
  for (const std::vector<int>& parents :
       std::vector<std::vector<int>>{{-1}, {-1, 0, 1, 2}, {-1, 0, 0, 1, 1, 0, 3}, {-1, -1, 0, 1}}) {
    const PoseTree poses = random_motion(parents, 9, parents.size());
    const auto trial = written(poses);
    EXPECT_EQ(trial.markers.time.rate_hz, 60.0);
    ASSERT_EQ(trial.markers.frames(), 9);
    for (std::size_t b = 0; b < parents.size(); ++b) {
      const auto joint = trial.markers.find("body_" + std::to_string(b));
      ASSERT_GE(joint, 0);
      for (std::int64_t f = 0; f < 9; ++f)
        EXPECT_LT((trial.markers.x(f, joint) - poses.pose(f, b).translation).norm(), 1e-7)
            << b << " in " << f;
      const auto end = trial.markers.find("body_" + std::to_string(b) + "_end");
      if (end < 0) continue;
      EXPECT_LT((trial.markers.x(8, end) - poses.pose(8, b) * Vector3d(0, 0.8, 0)).norm(), 1e-7)
          << "and turned as they were";
    }
  }
}

TEST_F(WriteBvh, OnlyBodiesThatMoveInTheOneAboveHavePositionsAndThenNoOffset) {
  written(random_motion({-1, 0, 1}, 5, 4));
  const std::string text = read_text(scratch_ / "a.bvh").value();
  EXPECT_THAT(text, HasSubstr("JOINT body_1\n  {\n    OFFSET 0.000000 0.000000 0.000000\n    CHANNELS 6 X"));
  EXPECT_THAT(text, HasSubstr("CHANNELS 3 Zrotation Xrotation Yrotation\n      End Site"));
  EXPECT_THAT(read_bvh(scratch_ / "a.bvh").value().warnings,
              Not(testing::Contains(HasSubstr("in their place"))));
}

TEST_F(WriteBvh, AnglesGoOnBeyondAHalfTurn) {
  PoseTree poses{.bodies = {{.name = "a"}}, .time = {.rate_hz = 10.0, .frames = 60}, .world_from_body = {}};
  for (int f = 0; f < 60; ++f)
    poses.world_from_body.push_back(
        {Eigen::AngleAxisd(0.2 * f, Vector3d::UnitZ()).toRotationMatrix(), Vector3d::Zero()});
  const auto trial = written(poses);
  EXPECT_NEAR(trial.channels.values.at(3 * 59), 0.2 * 59 * 180.0 / M_PI, 1e-5);
}

TEST_F(WriteBvh, RefusesWhatIsThereAndWhatIsNoMotion) {
  const PoseTree poses = random_motion({-1, 0}, 3, 1);
  ASSERT_TRUE(write_bvh(scratch_ / "b.bvh", poses, false));
  EXPECT_EQ(write_bvh(scratch_ / "b.bvh", poses, false).error().code, Code::io);
  PoseTree none = poses;
  none.world_from_body.clear();
  EXPECT_EQ(write_bvh(scratch_ / "c.bvh", none, false).error().code, Code::bad_input);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "c.bvh"));
}

}  // namespace
}  // namespace kinemark::io

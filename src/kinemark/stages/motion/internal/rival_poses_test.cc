// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A planar arm whose upper arm's marker is lost: the hand alone fits two poses, elbow to either side.
#include "kinemark/stages/motion/internal/rival_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/loose_bodies.h"
#include "kinemark/stages/motion/testing/planar_arm.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

data::ModelDescription arm() {
  return testing_body::planar_arm({0.0, -0.3, 0.0},
                                  {{.name = "U", .body_idx = 0, .x_in_body = {0.03, -0.15, 0.0}},
                                   {.name = "H", .body_idx = 1, .x_in_body = {0.0, -0.3, 0.0}}});
}

/// Elbow between 0.5 and 1.5 rad, or through 0 where `straight`.
Eigen::VectorXd angles(std::int64_t f, bool straight) {
  const double t = 0.01 * static_cast<double>(f);
  return Eigen::Vector2d(0.4 * std::sin(2.0 * t), (straight ? 0.0 : 1.0) + 0.5 * std::cos(2.2 * t));
}

class RivalPoses : public ::testing::Test {
 protected:
  RivalPoses() : model(model::Model::compile(arm()).value()) {}

  data::Trajectories record(bool straight = false) const {
    auto t = data::Trajectories::all_missing({"U", "H"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 300});
    model::Workspace w(model);
    Random random(5, 1);
    for (std::int64_t f = 0; f < 300; ++f) {
      model::kinematics(model, w, model::state_from_coordinates(model, angles(f, straight)));
      for (int m = 0; m < 2; ++m) {
        t.x(f, m) =
            w.marker.col(m) + 0.001 * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
        t.state[t.index(f, m)] = data::SampleState::measured;
      }
    }
    return t;
  }
  [[nodiscard]] static double off(const IkResult& r, std::int64_t f, int c, bool straight = false) {
    return std::abs(r.motion.q[r.motion.index(f, c)] - angles(f, straight)[c]);
  }

  model::Model model;
};

TEST_F(RivalPoses, FramesWithAllMarkersHaveNone) {
  const auto result = solve_ik(model, record()).value();
  EXPECT_TRUE(std::ranges::all_of(result.motion.determined, [](auto d) { return d != 0; }));
}

TEST_F(RivalPoses, TheMirrorPoseLosesToContinuity) {
  auto markers = record();
  for (std::int64_t f = 100; f < 140; ++f) markers.set_missing(f, 0);
  const auto result = solve_ik(model, markers).value();
  for (std::int64_t f = 100; f < 140; ++f)
    for (int c = 0; c < 2; ++c) {
      EXPECT_LT(off(result, f, c), 0.06);
      EXPECT_NE(result.motion.determined[result.motion.index(f, c)], 0) << f;
    }
}

TEST_F(RivalPoses, AWrongStartIsPutRightByTheFramesBehind) {
  auto markers = record();
  for (std::int64_t f = 100; f < 140; ++f) markers.set_missing(f, 0);
  const auto problem = make_problem(model, markers, {}).value();
  const IkOptions options;
  const Progress progress;
  FrameWalk walk(problem, options, progress);
  SolvedFrames solved;
  ASSERT_TRUE(walk.run(markers, false, solved));
  // The walk had taken the mirror pose from frame 110 on.
  for (std::int64_t f = 110; f < 140; ++f) {
    const double elbow = solved.states(1, f);
    Eigen::VectorXd mirrored = solved.states.col(f);
    mirrored[0] += elbow;  // links of one length: the forearm's direction becomes the upper arm's
    mirrored[1] = -elbow;
    walk.put(markers, f, mirrored, solved);
    ASSERT_LT(solved.cost[static_cast<std::size_t>(f)], 1e-5) << "it fits";
  }
  const MarkerVariances variances{.own = Eigen::Vector2d::Constant(1e-6), .common = Eigen::Vector2d::Zero()};
  std::vector<std::uint8_t> changed;
  const auto loose = find_loose_frames(problem, markers);
  (void)choose_among_rivals(problem, options, markers, loose, variances, walk, solved, changed);
  for (std::int64_t f = 110; f < 140; ++f) {
    EXPECT_NEAR(solved.states(1, f), angles(f, false)[1], 0.06) << f;
    EXPECT_EQ(changed[static_cast<std::size_t>(f)], 1);
  }
  EXPECT_EQ(changed[50], 0);
}

TEST_F(RivalPoses, ASingleFrameOnTheMirrorPoseIsPutRightWhereAnglesLeap) {
  // Both markers of the forearm fix it; one frame between two searches has only one of them. Elsewhere the
  // angles leap by 0.3 rad, as badly held ones do: that says nothing of a pose one radian away.
  auto description = arm();
  description.markers.push_back({.name = "W", .body_idx = 1, .x_in_body = {0.04, -0.1, 0.0}});
  const auto three = model::Model::compile(description).value();
  auto markers =
      data::Trajectories::all_missing({"U", "H", "W"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 300});
  model::Workspace w(three);
  for (std::int64_t f = 0; f < 300; ++f) {
    model::kinematics(three, w, model::state_from_coordinates(three, angles(f, false)));
    for (int m = 0; m < 3; ++m) {
      markers.x(f, m) = w.marker.col(m);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  }
  for (std::int64_t f = 130; f < 160; ++f) markers.set_missing(f, 0);
  constexpr std::int64_t kAlone = 133;
  markers.set_missing(kAlone, 2);
  const auto problem = make_problem(three, markers, {}).value();
  const IkOptions options;
  const Progress progress;
  FrameWalk walk(problem, options, progress);
  SolvedFrames solved;
  ASSERT_TRUE(walk.run(markers, false, solved));
  for (std::int64_t f = 0; f < 100; f += 2)
    walk.put(markers, f, solved.states.col(f) + Eigen::Vector2d(0.3, 0.3), solved);
  const double elbow = solved.states(1, kAlone);
  walk.put(markers, kAlone, solved.states.col(kAlone) + Eigen::Vector2d(elbow, -2.0 * elbow), solved);
  ASSERT_LT(solved.cost[static_cast<std::size_t>(kAlone)], 1e-5) << "it fits";
  const MarkerVariances variances{.own = Eigen::Vector3d::Constant(1e-6), .common = Eigen::Vector2d::Zero()};
  std::vector<std::uint8_t> changed;
  const auto loose = find_loose_frames(problem, markers);
  ASSERT_GE(loose.pattern[kAlone], 0);
  (void)choose_among_rivals(problem, options, markers, loose, variances, walk, solved, changed);
  EXPECT_NEAR(solved.states(1, kAlone), angles(kAlone, false)[1], 0.06);
  EXPECT_EQ(changed[kAlone], 1);
  EXPECT_EQ(changed[kAlone - 1], 0);
}

TEST_F(RivalPoses, BetweenStretchedArmsNobodyKnowsAndItIsSaid) {
  // The elbow passes 0 twice while the upper arm is not seen: either side fits in between.
  auto markers = record(true);
  std::int64_t first = 0, last = 0;  // frames in which the elbow is bent backwards
  for (std::int64_t f = 1; f < 300; ++f) {
    if (angles(f, true)[1] < 0.0 && first == 0) first = f;
    if (first > 0 && angles(f, true)[1] < 0.0) last = f;
  }
  ASSERT_GT(last, first + 60);
  ASSERT_LT(last, 299);
  for (std::int64_t f = first - 15; f <= std::min<std::int64_t>(298, last + 5); ++f)
    markers.set_missing(f, 0);
  const auto result = solve_ik(model, markers).value();
  const std::int64_t middle = (first + last) / 2;
  for (int c = 0; c < 2; ++c) EXPECT_EQ(result.motion.determined[result.motion.index(middle, c)], 0);
  for (std::int64_t f = 0; f < 300; ++f)
    for (int c = 0; c < 2; ++c) {
      const auto i = result.motion.index(f, c);
      if (result.motion.determined[i] == 0) continue;
      EXPECT_LT(off(result, f, c, true), 5.0 * result.motion.q_sd[i]) << f << " " << c;
    }
}

TEST_F(RivalPoses, DoubtWidensByTheShareAndEndsDetermination) {
  const auto problem = make_problem(model, record(), {}).value();
  data::JointMotion motion;
  motion.coordinates = {"shoulder", "elbow"};
  motion.is_rotation = {true, true};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 2};
  motion.q = {0.5, 1.0, 0.5, 1.0};
  motion.q_sd.assign(4, 0.01);
  motion.determined.assign(4, 1);
  const Eigen::Vector2d rival(0.5, -1.0);
  doubt_rivals(
      problem,
      {{.frame = 0, .state = rival, .probability = 1e-4}, {.frame = 1, .state = rival, .probability = 0.2}},
      motion);
  EXPECT_EQ(motion.q_sd[0], 0.01) << "they agree about the shoulder";
  EXPECT_NEAR(motion.q_sd[1], std::hypot(0.01, 0.01 * 2.0), 1e-9);
  EXPECT_EQ(motion.determined[1], 1);
  EXPECT_EQ(motion.determined[2], 1);
  EXPECT_EQ(motion.determined[3], 0);
  EXPECT_TRUE(std::isnan(motion.q_sd[3]));
}

TEST_F(RivalPoses, ASmallDifferenceWidensWhatIsKnownWell) {
  // 8 mrad apart where 1 mrad is claimed: too near to be another pose, too far for the deviation.
  const auto problem = make_problem(model, record(), {}).value();
  data::JointMotion motion;
  motion.coordinates = {"shoulder", "elbow"};
  motion.is_rotation = {true, true};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1};
  motion.q = {0.5, 1.0};
  motion.q_sd = {0.001, 0.01};
  motion.determined.assign(2, 1);
  const Eigen::Vector2d rival(0.508, -1.0);
  doubt_rivals(problem, {{.frame = 0, .state = rival, .probability = 0.05}}, motion);
  EXPECT_NEAR(motion.q_sd[0], std::hypot(0.001, std::sqrt(0.05) * 0.008), 1e-9);
  EXPECT_EQ(motion.determined[0], 1);
  EXPECT_EQ(motion.determined[1], 0);
}

}  // namespace
}  // namespace kinemark::motion::internal

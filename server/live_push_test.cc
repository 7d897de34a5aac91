// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_push.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/pipeline/live/live_input.h"
#include "server/testing/fake_clock.h"
#include "server/testing/push_bytes.h"

namespace kinemark::server {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::push_bytes;

TEST(LivePush, BytesAreABodyAPointAndAForce) {
  const LivePush push(3);
  const auto read = push.read(push_bytes(2, {0.5, -0.25, 1.0}, {100.0, -200.0, 0.5}));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->body, 2);
  EXPECT_EQ(read->point_in_body, Vector3d(0.5, -0.25, 1.0));
  EXPECT_EQ(read->force_in_world, Vector3d(100.0, -200.0, 0.5));
}

TEST(LivePush, OtherBytesAreNotUnderstood) {
  const LivePush push(3);
  const auto good = push_bytes(2, Vector3d::Zero(), Vector3d::UnitX());
  ASSERT_TRUE(push.read(good));
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_FALSE(push.read(push_bytes(2, {0.0, wrong, 0.0}, Vector3d::UnitX())));
    EXPECT_FALSE(push.read(push_bytes(2, Vector3d::Zero(), {0.0, 0.0, wrong})));
  }
  EXPECT_FALSE(push.read(push_bytes(3, Vector3d::Zero(), Vector3d::UnitX()))) << "a body that is none";
  EXPECT_FALSE(push.read(push_bytes(65'535, Vector3d::Zero(), Vector3d::UnitX())));
  for (const std::size_t at : {0U, 1U}) {
    auto other = good;
    other[at] = 9;
    EXPECT_FALSE(push.read(other)) << "kind, version";
  }
  EXPECT_FALSE(push.read(good.substr(1)));
  EXPECT_FALSE(push.read(good + "x"));
  EXPECT_FALSE(push.read(""));
}

TEST(LivePush, AnyBytesAreReadOrNot) {
  LivePush push(3);
  Random random(7, 0);
  int read = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes(kPushBytes, '\0');
    for (auto& byte : bytes) byte = static_cast<char>(static_cast<int>(256.0 * random.uniform()));
    bytes[0] = bytes[1] = 1;
    bytes[2] = static_cast<char>(static_cast<int>(4.0 * random.uniform()));
    bytes[3] = 0;
    const auto wish = push.read(bytes);
    if (!wish) continue;
    ++read;
    EXPECT_LT(wish->body, 3);
    (void)push.take(&push, *wish, i);
    const auto now = push.now(i);
    if (now) EXPECT_LE(now->force_in_world.norm(), 500.0);
  }
  EXPECT_GT(read, 5000);
}

TEST(LivePush, OneViewerPushesAtATime) {
  LivePush push(3);
  const int a = 0, b = 0;
  const BodyPush left{.body = 1, .force_in_world = {-10.0, 0.0, 0.0}},
      right{.body = 2, .force_in_world = {10.0, 0.0, 0.0}};
  EXPECT_FALSE(push.now(0.0));
  EXPECT_EQ(push.take(&a, left, 0.0), "");
  EXPECT_THAT(push.take(&b, right, 0.5), HasSubstr("another page is pushing the body"));
  EXPECT_EQ(push.now(0.5)->body, 1);
  EXPECT_EQ(push.take(&b, {}, 0.6), "") << "who does not push may let go";
  EXPECT_TRUE(push.now(0.6)) << "of nothing";
  EXPECT_EQ(push.take(&a, {}, 0.7), "");
  EXPECT_FALSE(push.now(0.7));
  EXPECT_EQ(push.take(&b, right, 0.8), "");
  EXPECT_EQ(push.now(0.8)->body, 2);
  push.let_go(&a);
  EXPECT_TRUE(push.now(0.8));
  push.let_go(&b);
  EXPECT_FALSE(push.now(0.8)) << "its page was closed";
}

TEST(LivePush, WhatIsNotSaidAgainEnds) {
  LivePush push(1);
  const int a = 0, b = 0;
  const BodyPush wish{.force_in_world = {10.0, 0.0, 0.0}};
  EXPECT_EQ(push.take(&a, wish, 10.0), "");
  EXPECT_TRUE(push.now(10.9));
  EXPECT_EQ(push.take(&a, wish, 10.9), "");
  EXPECT_TRUE(push.now(11.8));
  EXPECT_EQ(push.take(&b, wish, 12.0), "") << "the page of a is silent";
  EXPECT_FALSE(push.now(13.1));
}

TEST(LivePush, AForceBeyondTheLimitIsNotApplied) {
  LivePush push(1);
  EXPECT_EQ(push.take(&push, {.force_in_world = {0.0, 501.0, 0.0}}, 0.0),
            "the body is pushed by at most 500 N; 501 N were not applied");
  EXPECT_FALSE(push.now(0.0));
  EXPECT_EQ(push.take(&push, {.force_in_world = {0.0, 500.0, 0.0}}, 0.0), "");
  EXPECT_TRUE(push.now(0.0));
}

TEST(BodyPoses, AreThoseOfThePushedBodyWhileThereIsOne) {
  const auto input = pipeline::open_live_input("sim:walk?seconds=0.1").value();
  const auto& model = *input.model;
  BodyPoses body_poses(input.model);
  motion::LivePose pose;
  pose.q = Eigen::VectorXd::Constant(model.coordinate_count(), 0.1);
  const auto there = body_poses.find(pose);
  ASSERT_EQ(there.size(), kPoseNumbers * model.bodies().size());
  model::Workspace w(model);
  model::kinematics(model, w, model::state_from_coordinates(model, pose.q));
  const Vector3d point(0.1, 0.2, 0.3);
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const double* place = there.data() + kPoseNumbers * b;
    const Vector3d x = Vector3d(place[0], place[1], place[2]) +
                       Eigen::Quaterniond(place[3], place[4], place[5], place[6]) * point;
    EXPECT_LT((x - model::point_in_world(w, static_cast<int>(b), point)).norm(), 1e-12);
  }
  pose.pushed_q = pose.q.array() + 0.2;
  EXPECT_NE(body_poses.find(pose), there);
  pose.q = pose.pushed_q;
  pose.pushed_q.resize(0);
  const auto same = body_poses.find(pose);
  pose.pushed_q = pose.q;
  EXPECT_EQ(body_poses.find(pose), same);
  pose.pushed_q.resize(0);
  pose.q.setConstant(kNaN);
  for (const double value : body_poses.find(pose)) EXPECT_TRUE(std::isnan(value));
}

TEST(PushedAngles, TheBodyGoesAndComesBackAndTheAnglesStay) {
  // The kinematic truth of these frames does not matter, only that they are the same twice.
  constexpr const char* kStand = "sim:walk?rate=100&seconds=3";
  const auto clock = std::make_shared<testing::FakeClock>();
  const auto run = [&clock](bool pushes) {
    const auto input = pipeline::open_live_input(kStand).value();
    const auto push = std::make_shared<LivePush>(input.model->bodies().size());
    std::vector<motion::LivePose> poses;
    auto made = workflow::live(*input.model, input.source->facts(),
                               [&poses](const auto& pose) { poses.push_back(pose); });
    PushedAngles angles(std::move(*made), push, clock);
    const int hand = static_cast<int>(input.model->bodies().size()) - 1;
    for (stream::Frame frame; input.source->next(frame).value();) {
      if (pushes && frame.number == 100)
        EXPECT_EQ(push->take(&input, {.body = hand, .force_in_world = {0.0, 0.0, 300.0}}, clock->now_s()),
                  "");
      if (frame.number == 150) EXPECT_EQ(push->take(&input, {}, clock->now_s()), "");
      EXPECT_TRUE(angles.push(frame));
    }
    EXPECT_TRUE(angles.finish());
    return poses;
  };
  const auto alone = run(false), pushed = run(true);
  ASSERT_EQ(alone.size(), pushed.size());
  double farthest_m = 0.0;
  for (std::size_t f = 0; f < alone.size(); ++f) {
    EXPECT_TRUE((alone[f].q.array() == pushed[f].q.array() || alone[f].q.array().isNaN()).all()) << f;
    farthest_m = std::max(farthest_m, pushed[f].pushed_m);
  }
  EXPECT_GT(farthest_m, 0.005);
  EXPECT_EQ(pushed.front().pushed_q.size(), 0);
  EXPECT_EQ(pushed.back().pushed_q.size(), 0);
}

}  // namespace
}  // namespace kinemark::server

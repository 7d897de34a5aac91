// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which markers a body may lose before more than one pose fits those that are left.
#include "kinemark/stages/motion/internal/loose_bodies.h"

#include <gtest/gtest.h>

#include <iterator>

#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using Frames = std::vector<std::int64_t>;

data::AxisDescription axis(bool is_rotation, const Vector3d& direction, int coordinate) {
  return {.is_rotation = is_rotation, .axis = direction, .coordinate_idx = coordinate};
}

/// A trunk free in the room, an upper arm on a ball or a slide, a forearm on a hinge and a hand on another.
data::ModelDescription arm_on_a_trunk(bool slides = false) {
  data::ModelDescription m;
  m.name = "arm on a trunk";
  for (const char* name : {"trunk", "upper", "fore", "hand"})
    m.bodies.push_back({.name = name, .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity() * 0.01});
  for (const char* name : {"x", "y", "z"}) m.coordinates.push_back({.name = name, .is_rotation = false});
  for (const char* name : {"rx", "ry", "rz"}) m.coordinates.push_back({.name = name});
  for (const char* name : {"a", "b", "c"}) m.coordinates.push_back({.name = name, .is_rotation = !slides});
  m.coordinates.push_back({.name = "elbow", .default_value = 0.7});
  m.coordinates.push_back({.name = "wrist"});
  const Vector3d unit[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  data::JointDescription root{.name = "root", .child_body_idx = 0}, shoulder{.name = "shoulder"};
  for (int i = 0; i < 3; ++i) root.axes.push_back(axis(false, unit[i], i));
  for (int i = 0; i < 3; ++i) root.axes.push_back(axis(true, unit[i], 3 + i));
  for (int i = 0; i < 3; ++i) shoulder.axes.push_back(axis(!slides, unit[i], 6 + i));
  shoulder.parent_body_idx = 0;
  shoulder.child_body_idx = 1;
  shoulder.parent_from_joint = {Eigen::Matrix3d::Identity(), {0.0, 0.4, 0.2}};
  m.joints = {root, shoulder};
  const char* names[] = {"elbow", "wrist"};
  for (int i = 0; i < 2; ++i)
    m.joints.push_back({.name = names[i],
                        .parent_body_idx = 1 + i,
                        .child_body_idx = 2 + i,
                        .parent_from_joint = {Eigen::Matrix3d::Identity(), {0.0, -0.3, 0.0}},
                        .axes = {axis(true, Vector3d::UnitZ(), 9 + i)}});
  const auto marker = [&](const char* name, int of, const Vector3d& x) {
    m.markers.push_back({.name = name, .body_idx = of, .x_in_body = x});
  };
  marker("T1", 0, {0.1, 0.0, 0.1});
  marker("T2", 0, {0.1, 0.0, -0.1});
  marker("T3", 0, {0.1, 0.3, 0.0});
  marker("T4", 0, {0.1, 0.2, -0.05});  // on the line through T2 and T3, nearly
  marker("U1", 1, {0.0, -0.1, 0.0});   // on the line through shoulder and elbow
  marker("U2", 1, {0.04, -0.15, 0.0});
  marker("F1", 2, {0.03, -0.1, 0.0});
  marker("F2", 2, {0.0, -0.2, 0.04});
  marker("F3", 2, {-0.03, -0.12, 0.0});
  marker("H1", 3, {0.0, -0.08, 0.0});
  return m;
}

class LooseBodies : public ::testing::Test {
 protected:
  /// Frames of one pose; each list of names is lost in the frame behind the first, which sees all.
  static LooseFrames find(const data::ModelDescription& description,
                          const std::vector<std::vector<const char*>>& lost, double least_s = 0.0) {
    const auto model = model::Model::compile(description).value();
    std::vector<std::string> names;
    for (const auto& marker : description.markers) names.push_back(marker.name);
    const auto frames = std::ssize(lost) + 1;
    auto t = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
    model::Workspace w(model);
    model::kinematics(model, w, model.default_state());
    for (std::int64_t f = 0; f < frames; ++f)
      for (std::int64_t i = 0; i < t.markers(); ++i) {
        t.x(f, i) = w.marker.col(i);
        t.state[t.index(f, i)] = data::SampleState::measured;
      }
    for (std::size_t k = 0; k < lost.size(); ++k)
      for (const char* name : lost[k]) t.set_missing(static_cast<std::int64_t>(k) + 1, t.find(name));
    return find_loose_frames(make_problem(model, t, {}).value(), t, least_s);
  }
  static Frames loose(const data::ModelDescription& description,
                      const std::vector<std::vector<const char*>>& lost) {
    return find(description, lost).pattern;
  }
};

TEST_F(LooseBodies, AllMarkersLeaveNoneLoose) {
  EXPECT_EQ(loose(arm_on_a_trunk(), {{}, {}}), (Frames{-1, -1, -1}));
}

TEST_F(LooseBodies, ThreeMarkersOffALineFixTheirBody) {
  EXPECT_EQ(loose(arm_on_a_trunk(true), {{"T4"}, {"T1"}, {"T2"}}), (Frames{-1, -1, 0, -1}))
      << "T2, T3 and T4 lie on a line, T1, T3 and T4 do not";
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"T1"}}), (Frames{-1, -1})) << "the shoulder is known by the arm";
}

TEST_F(LooseBodies, JointsToFixedBodiesCountAsPoints) {
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"U1"}, {"U1", "U2"}}), (Frames{-1, -1, -1}))
      << "shoulder and elbow are known";
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"U1", "F1", "F2"}, {"U2", "F1"}}), (Frames{-1, 0, 1}))
      << "a marker and the shoulder leave the upper arm free about their line, and the forearm with it";
}

TEST_F(LooseBodies, AHingeToAFixedBodyIsALine) {
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"F1"}, {"F1", "F2"}, {"F1", "F2", "F3"}}), (Frames{-1, -1, -1, 0}))
      << "one marker off the elbow's axis is enough, none is not";
}

TEST_F(LooseBodies, BehindTheLastMarkerThereIsNothingToMistake) {
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"H1"}, {"F1", "F2", "F3", "H1"}}), (Frames{-1, -1, -1}))
      << "open, and said to be";
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"U1", "U2", "F1", "F2", "F3"}}), (Frames{-1, 0}))
      << "the hand is seen behind them";
}

TEST_F(LooseBodies, ASlidingJointHasNoCentre) {
  EXPECT_EQ(loose(arm_on_a_trunk(false), {{"F1"}}), (Frames{-1, -1}));
  EXPECT_EQ(loose(arm_on_a_trunk(true), {{"F1"}}), (Frames{-1, 0}))
      << "two markers do not fix an upper arm that slides";
}

TEST_F(LooseBodies, LockedJointsMakeOneBodyOfTwo) {
  EXPECT_EQ(loose(arm_on_a_trunk(), {{"U1", "F2"}}), (Frames{-1, 0}));
  auto locked = arm_on_a_trunk();
  locked.coordinates[9].locked = true;
  EXPECT_EQ(loose(locked, {{"U1", "F2"}}), (Frames{-1, -1})) << "U2, F1, F3 and the shoulder";
}

TEST_F(LooseBodies, PatternsAreNumberedAsTheyAppear) {
  EXPECT_EQ(loose(arm_on_a_trunk(true), {{"T1"}, {"T1", "T4"}, {"T1"}, {}, {"T1", "T4"}}),
            (Frames{-1, 0, 1, 0, -1, 1}));
}

TEST_F(LooseBodies, AMarkerOfAnotherBodyMakesNoOtherPattern) {
  EXPECT_EQ(loose(arm_on_a_trunk(true), {{"T1"}, {"T1", "H1"}}), (Frames{-1, 0, 0}));
}

TEST_F(LooseBodies, ForAShortTimeTheFramesBesideTell) {
  const std::vector<std::vector<const char*>> four(4, {"T1"}), five(5, {"T1"});
  EXPECT_FALSE(find(arm_on_a_trunk(true), four, 0.05).any()) << "40 ms";
  const auto long_enough = find(arm_on_a_trunk(true), five, 0.05);
  EXPECT_TRUE(long_enough.any());
  EXPECT_EQ(long_enough.pattern, (Frames{-1, 0, 0, 0, 0, 0}));
  auto turns = five;  // the trunk is loose all along, the upper arm for 20 ms
  turns[1] = turns[2] = {"T1", "U1", "F1"};
  EXPECT_EQ(find(arm_on_a_trunk(true), turns, 0.05).pattern, (Frames{-1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(find(arm_on_a_trunk(true), turns, 0.01).pattern, (Frames{-1, 0, 1, 1, 0, 0}));
}

TEST_F(LooseBodies, SpeedsAreThoseOfTheJointsAtALooseBody) {
  const auto trunk = find(arm_on_a_trunk(true), {{"T1"}});
  ASSERT_EQ(trunk.speeds.size(), 1U);
  EXPECT_EQ(trunk.speeds[0], (std::vector<std::uint8_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0}));
  const auto forearm = find(arm_on_a_trunk(), {{"F1", "F2", "F3"}});
  ASSERT_EQ(forearm.speeds.size(), 1U);
  EXPECT_EQ(forearm.speeds[0], (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1}));
}

TEST_F(LooseBodies, WhatABodyNeverHadItDoesNotLose) {
  auto without = arm_on_a_trunk(true);
  std::erase_if(without.markers, [](const auto& m) { return m.name == "T1"; });
  EXPECT_EQ(loose(without, {{"T4"}}), (Frames{-1, 0})) << "T2 and T3 are left";
  EXPECT_EQ(loose(without, {{}}), (Frames{-1, -1})) << "the three near a line are all there are";
}

}  // namespace
}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/body/motion_cycles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::pipeline {
namespace {

using data::Quantity;
using data::Side;
using ::testing::ElementsAre;

// Three coordinates through 3 s: a knee (angle t), a root's shift (2 t) and one that follows another.
struct Moved {
  workflow::MotionMeasured measured;
  std::vector<analysis::GaitCycle> cycles{{.side = Side::left, .start_s = 0.5, .end_s = 1.5},
                                          {.side = Side::right, .start_s = 1.0, .end_s = 2.0}};

  explicit Moved(bool torques) {
    const TimeBase time{.rate_hz = 100.0, .frames = 301};
    auto& motion = measured.motion;
    motion.time = time;
    motion.coordinates = {"knee_angle_l", "pelvis_tx", "knee_angle_l_beta"};
    motion.is_rotation = {true, false, true};
    auto& record = measured.record;
    record.time = time;
    record.names = motion.coordinates;
    record.is_rotation = {true, false, true};
    record.measured = {true, true, false};
    record.driven = {true, false, false};
    record.q.resize(301, 3);
    record.q_sd = Eigen::MatrixXd::Constant(301, 3, 0.02);
    record.determined = Eigen::MatrixX<bool>::Constant(301, 3, true);
    for (int f = 0; f < 301; ++f) {
      const double t = 0.01 * f;
      record.q.row(f) << t, 2.0 * t, t;
      motion.qd.insert(motion.qd.end(), {1.0, 2.0, 1.0});
      if (torques) motion.tau.insert(motion.tau.end(), {10.0 * t, 20.0 * t, 10.0 * t});
    }
    if (torques) record.torque_known = Eigen::MatrixX<bool>::Constant(301, 3, true);
  }
  std::vector<SheetInput> curves() {
    std::vector<SheetInput> out;
    add_motion_cycles(measured, cycles, out);
    return out;
  }
};

std::vector<std::string> names(const std::vector<SheetInput>& inputs) {
  std::vector<std::string> out;
  for (const auto& one : inputs) out.push_back(one.curves.id + " " + one.curves.context);
  return out;
}

TEST(MotionCycles, AreOfCoordinatesThatMoveByThemselves) {
  const auto out = Moved(false).curves();
  EXPECT_THAT(names(out), ElementsAre("knee_angle_l Left", "pelvis_tx Left", "pelvis_tx Right"));
  EXPECT_NEAR(out[0].curves(0, 50), 1.0, 1e-9);
  EXPECT_NEAR(out[0].curves.sd[50], 0.02, 1e-12);
  EXPECT_EQ(out[1].curves.quantity, Quantity::length);
  EXPECT_NEAR(out[2].curves(0, 0), 2.0, 1e-9);
}

TEST(MotionCycles, MomentsAndPowersWhereTorquesAreKnown) {
  const auto out = Moved(true).curves();
  EXPECT_THAT(names(out), ElementsAre("knee_angle_l Left", "pelvis_tx Left", "pelvis_tx Right",
                                      "knee_angle_l_moment Left", "knee_angle_l_power Left"));
  EXPECT_EQ(out[3].curves.quantity, Quantity::moment);
  EXPECT_NEAR(out[3].curves(0, 50), 10.0, 1e-9);  // at 1 s
  EXPECT_EQ(out[4].curves.quantity, Quantity::power);
  EXPECT_NEAR(out[4].curves(0, 50), 10.0, 1e-9);  // times a rate of 1
}

TEST(MotionCycles, WhatIsNotDeterminedIsMissing) {
  Moved moved(true);
  moved.measured.record.determined(100, 0) = false;
  moved.measured.record.torque_known(120, 0) = false;
  const auto out = moved.curves();
  EXPECT_TRUE(std::isnan(out[0].curves(0, 50)));
  EXPECT_TRUE(std::isnan(out[3].curves(0, 50)));
  EXPECT_FALSE(std::isnan(out[0].curves(0, 70)));
  EXPECT_TRUE(std::isnan(out[3].curves(0, 70)));
}

}  // namespace
}  // namespace kinemark::pipeline

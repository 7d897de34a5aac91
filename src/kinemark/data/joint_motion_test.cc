// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/joint_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

JointMotion small() {
  JointMotion m;
  m.coordinates = {"hip", "knee"};
  m.is_rotation = {true, true};
  m.markers = {"A"};
  m.time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = 3};
  m.q.assign(6, 0.5);
  m.q_sd.assign(6, 0.01);
  m.determined.assign(6, 1);
  m.marker_error.assign(9, 0.0);
  m.status.assign(3, FrameStatus::converged);
  return m;
}

TEST(JointMotion, ValidatesAndFinds) {
  const JointMotion m = small();
  EXPECT_TRUE(m.validate());
  EXPECT_EQ(m.find("knee"), 1);
  EXPECT_EQ(m.find("ankle"), -1);
  EXPECT_EQ(m.index(2, 1), 5U);
}

TEST(JointMotion, ValidateNamesTheFieldAndThePlace) {
  JointMotion m = small();
  m.q.resize(5);
  EXPECT_THAT(m.validate().error().message, HasSubstr("5 numbers of q; need 6"));
  m = small();
  m.q[3] = std::nan("");
  EXPECT_THAT(m.validate().error().message, HasSubstr("'knee' of frame 1"));
  for (auto* field : {&m.q_sd, &m.qd, &m.qdd, &m.tau, &m.tau_sd, &m.q_bound, &m.marker_error}) {
    m = small();
    field->resize(1);
    EXPECT_FALSE(m.validate());
  }
  m = small();
  m.status.clear();
  m.determined.clear();
  m.q_sd.clear();
  EXPECT_TRUE(m.validate()) << "the optional fields may be absent";
}

TEST(JointMotion, TheClockMustRun) {
  for (const double rate_hz : {0.0, -60.0, std::nan(""), HUGE_VAL}) {
    JointMotion m = small();
    m.time.rate_hz = rate_hz;
    EXPECT_THAT(m.validate().error().message, HasSubstr("Hz")) << rate_hz;
  }
  JointMotion m = small();
  m.time.t0_s = std::nan("");
  EXPECT_THAT(m.validate().error().message, HasSubstr("from nan s on"));
  m = {};
  m.time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = -1};
  EXPECT_THAT(m.validate().error().message, HasSubstr("-1 frames"));
}

TEST(JointMotion, NoFramesAndNoCoordinatesAreAMotion) {
  JointMotion m;
  m.time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = 0};
  m.coordinates = {"hip"};
  m.is_rotation = {true};
  EXPECT_TRUE(m.validate());
  m.time.frames = 4;
  m.coordinates.clear();
  m.is_rotation.clear();
  EXPECT_TRUE(m.validate()) << "nothing to tell of four frames";
}

TEST(FrameStatus, EveryStatusHasItsOwnName) {
  std::set<std::string_view> names;
  for (int s = 0; s < 4; ++s) names.insert(to_string(static_cast<FrameStatus>(s)));
  EXPECT_EQ(names.size(), 4U);
}

}  // namespace
}  // namespace kinemark::data

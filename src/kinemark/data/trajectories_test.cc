// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/trajectories.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

Trajectories two_by_two() {
  Trajectories t = Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 1.0, .frames = 2});
  t.x(0, 1) = Eigen::Vector3d(1, 2, 3);
  t.state[t.index(0, 1)] = SampleState::measured;
  return t;
}

TEST(Trajectories, StartAllMissingAndCountWhatIsNotThere) {
  const Trajectories t = two_by_two();
  ASSERT_TRUE(t.validate()) << t.validate().error().message;
  EXPECT_EQ(t.count_missing(), 3);
  EXPECT_TRUE(t.present(0, 1));
  EXPECT_FALSE(t.present(1, 0));
  EXPECT_EQ(t.x(0, 1).y(), 2.0);
  EXPECT_EQ(t.find("B"), 1);
  EXPECT_EQ(t.find("C"), -1);
  EXPECT_DOUBLE_EQ(t.time.time_s(1), 1.01);
  EXPECT_EQ(t.time.nearest_frame(1.0096), 1);
}

TEST(Trajectories, SetMissingWritesNanAndTheReason) {
  Trajectories t = two_by_two();
  t.set_missing(0, 1, SampleState::rejected);
  EXPECT_TRUE(t.x(0, 1).array().isNaN().all());
  EXPECT_EQ(t.count_missing(), 4);
  EXPECT_TRUE(t.validate());
}

TEST(Trajectories, ValidateNamesWhatIsWrong) {
  Trajectories t = two_by_two();
  t.names[1] = "A";
  EXPECT_THAT(t.validate().error().message, HasSubstr("'A' occurs twice"));
  t = two_by_two();
  t.names[0].clear();
  EXPECT_THAT(t.validate().error().message, HasSubstr("no name"));
  t = two_by_two();
  t.time.rate_hz = 0.0;
  EXPECT_THAT(t.validate().error().message, HasSubstr("rate of 0 Hz"));
  t = two_by_two();
  t.x_in_world.resize(3);
  EXPECT_THAT(t.validate().error().message, HasSubstr("hold 3 coordinates"));
  t = two_by_two();
  t.covariance.resize(5);
  EXPECT_THAT(t.validate().error().message, HasSubstr("covariance"));
  t = two_by_two();
  t.x(0, 1).x() = std::nan("");
  EXPECT_THAT(t.validate().error().message, HasSubstr("'B' frame 0 is marked measured"));
  t = two_by_two();
  t.x(1, 0).setZero();
  EXPECT_THAT(t.validate().error().message, HasSubstr("marked missing"));
}

TEST(Trajectories, RememberHowASampleWasMade) {
  Trajectories t = two_by_two();
  EXPECT_EQ(t.made_by(1, 1), "");
  t.set_method(1, 1, "cubic");
  t.set_method(0, 0, "rigid body");
  t.set_method(0, 1, "cubic");
  EXPECT_EQ(t.made_by(1, 1), "cubic");
  EXPECT_EQ(t.made_by(0, 0), "rigid body");
  EXPECT_EQ(t.made_by(1, 0), "");
  EXPECT_THAT(t.methods, testing::ElementsAre("cubic", "rigid body"));
  EXPECT_TRUE(t.validate());
  t.methods.pop_back();
  EXPECT_THAT(t.validate().error().message, HasSubstr("made by method 2; there are 1"));
}

TEST(Trajectories, SampleTimesMayDifferByMarkerOrBySample) {
  Trajectories t = two_by_two();
  const double second = t.time.time_s(1);
  EXPECT_EQ(t.time_s(1, 1), second);
  t.sample_offset_s = {0.0, 0.001};
  EXPECT_EQ(t.time_s(1, 1), second + 0.001);
  t.sample_offset_s = {0.0, 0.001, 0.002, 0.003};
  EXPECT_EQ(t.time_s(1, 0), second + 0.002);
  EXPECT_TRUE(t.validate());
  t.sample_offset_s.resize(3);
  EXPECT_THAT(t.validate().error().message, HasSubstr("3 sample times; need 2, 4 or none"));
}

TEST(SampleState, EveryStateHasItsOwnName) {
  std::set<std::string_view> names;
  for (int s = 0; s < 6; ++s) names.insert(to_string(static_cast<SampleState>(s)));
  EXPECT_EQ(names.size(), 6U);
}

}  // namespace
}  // namespace kinemark::data

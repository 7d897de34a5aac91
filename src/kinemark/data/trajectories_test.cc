// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/trajectories.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/check.h"

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

TEST(Trajectories, CountsWhatIsNotThereOfAnyLength) {
  for (const std::int64_t frames : {1, 65'536, 65'537, 200'001}) {
    auto t = Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
    EXPECT_EQ(t.count_missing(), frames);
    std::int64_t there = 0;
    for (std::int64_t f = 0; f < frames; f += 7, ++there)
      t.state[t.index(f, 0)] = f % 2 == 0 ? SampleState::measured : SampleState::interpolated;
    t.state.back() = SampleState::rejected;
    there -= (frames - 1) % 7 == 0;
    EXPECT_EQ(t.count_missing(), frames - there);
  }
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

TEST(Trajectories, FiltersAndUnfilteredSamplesAreOfAllMarkersOrOfNone) {
  Trajectories t = two_by_two();
  t.filters.assign(2, {.method = "kalman", .order = 3, .cutoff_hz = 8.0, .noise_sd_m = 1e-3});
  t.unfiltered_in_world = t.x_in_world;
  EXPECT_TRUE(t.validate());
  t.filters.pop_back();
  EXPECT_THAT(t.validate().error().message, HasSubstr("name the filters of 1 markers; need 2 or none"));
  t.filters.clear();
  t.unfiltered_in_world.resize(11);
  EXPECT_THAT(t.validate().error().message, HasSubstr("11 unfiltered coordinates; need 12 or none"));
}

TEST(Trajectories, TheClockMustRunAndFramesBeCounted) {
  for (const double rate_hz : {-100.0, std::nan(""), HUGE_VAL}) {
    Trajectories t = two_by_two();
    t.time.rate_hz = rate_hz;
    EXPECT_THAT(t.validate().error().message, HasSubstr("need a positive number")) << rate_hz;
  }
  Trajectories t = two_by_two();
  t.time.t0_s = HUGE_VAL;
  EXPECT_THAT(t.validate().error().message, HasSubstr("a time that is not a number"));
  t = {};
  t.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = -2};
  EXPECT_THAT(t.validate().error().message, HasSubstr("-2 frames"));
}

TEST(Trajectories, ASampleIsThereAsAWholeOrNotAtAll) {
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Trajectories t = two_by_two();
    t.x(0, 1).z() = wrong;
    EXPECT_THAT(t.validate().error().message, HasSubstr("'B' frame 0 is marked measured")) << wrong;
    t = two_by_two();
    t.set_missing(0, 1);
    t.x(0, 1).y() = 0.0;
    EXPECT_THAT(t.validate().error().message, HasSubstr("'B' frame 0 is marked missing"));
  }
}

TEST(Trajectories, MayHaveNoMarkersOrNoFrames) {
  auto t = Trajectories::all_missing({}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 5});
  EXPECT_TRUE(t.validate());
  EXPECT_EQ(t.count_missing(), 0);
  EXPECT_EQ(t.find(""), -1);
  t = Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 0});
  EXPECT_TRUE(t.validate());
}

TEST(Trajectories, HoldAtMost255Methods) {
  Trajectories t = two_by_two();
  for (int k = 1; k <= 255; ++k) t.set_method(0, 0, "method " + std::to_string(k));
  EXPECT_EQ(t.made_by(0, 0), "method 255");
  t.set_method(1, 1, "method 7");
  EXPECT_EQ(t.methods.size(), 255U) << "a name that is known takes no room";
  EXPECT_THROW(t.set_method(1, 0, "one more"), ContractError);
  EXPECT_EQ(t.made_by(1, 0), "");
  EXPECT_TRUE(t.validate());
  t.method.pop_back();
  EXPECT_THAT(t.validate().error().message, HasSubstr("3 method numbers; need 4 or none"));
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

TEST(Trajectories, ASampleThatIsTakenAwayWasNotMeasuredBeforeItsFilterEither) {
  auto t = Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 2});
  t.unfiltered_in_world.assign(12, 1.0);
  t.set_missing(1, 0, SampleState::rejected);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(std::isnan(t.unfiltered_in_world[i]), i >= 6 && i < 9) << i;
}

}  // namespace
}  // namespace kinemark::data

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/hand_on.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/data/filtering.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;

/// Three seconds of two markers with 0.4 mm of noise; frame 50 of the first was made by the recorder, frame
/// 60 is missing, frame 70 was filled and frame 80 rejected.
data::Trajectories recording() {
  auto t = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 300});
  Random noise(8, 0);
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      const double s = 0.01 * static_cast<double>(f);
      t.x(f, m) = Eigen::Vector3d(std::sin(4.0 * s), 0.2 * std::cos(3.0 * s), 0.1 * s);
      for (int axis = 0; axis < 3; ++axis) t.x(f, m)[axis] += 4e-4 * noise.gaussian();
      t.state[t.index(f, m)] = SampleState::measured;
    }
  t.state[t.index(50, 0)] = SampleState::upsampled;
  t.set_method(50, 0, "recorder");
  t.set_missing(60, 0);
  t.state[t.index(70, 0)] = SampleState::interpolated;
  t.set_method(70, 0, "cubic");
  t.set_missing(80, 0, SampleState::rejected);
  return t;
}

Eigen::Vector3d before(const data::Trajectories& t, std::int64_t f, std::int64_t m) {
  return Eigen::Map<const Eigen::Vector3d>(t.unfiltered_in_world.data() + 3 * t.index(f, m));
}

TEST(HandOn, SmoothingTellsItsFilterAndKeepsMeasuredSamples) {
  const auto in = recording();
  const auto out = smooth(in, {.max_bridge_s = 0.5});
  ASSERT_TRUE(out) << out.error().message;
  const auto& t = out->trajectories;
  ASSERT_TRUE(t.validate()) << t.validate().error().message;
  ASSERT_EQ(t.filters.size(), 2U);
  for (std::int64_t m = 0; m < 2; ++m) {
    const auto& stated = t.filters[static_cast<std::size_t>(m)];
    const auto& used = out->markers[static_cast<std::size_t>(m)].used;
    EXPECT_EQ(stated.method, "kalman");
    EXPECT_EQ(stated.order, used.order);
    EXPECT_EQ(stated.cutoff_hz, used.cutoff_hz);
    EXPECT_NEAR(stated.noise_sd_m, 4e-4, 0.6e-4);
  }
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      if (in.state[in.index(f, m)] == SampleState::measured) {
        EXPECT_EQ(before(t, f, m), Eigen::Vector3d(in.x(f, m))) << f;
        EXPECT_EQ(t.made_by(f, m), "smoothed by kalman");
      } else {
        EXPECT_TRUE(before(t, f, m).array().isNaN().all()) << f << ": nobody measured it";
        EXPECT_NE(t.made_by(f, m), "smoothed by kalman") << f;
      }
    }
  EXPECT_EQ(t.state[t.index(60, 0)], SampleState::interpolated) << "bridged";
}

TEST(HandOn, WithoutAFilterNothingIsSaid) {
  const auto out = smooth(recording(), {.method = FilterMethod::none});
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->trajectories.filters.empty());
  EXPECT_TRUE(out->trajectories.unfiltered_in_world.empty());
  EXPECT_EQ(out->trajectories.made_by(0, 0), "");
}

TEST(HandOn, WithoutAFilterWhatIsKnownIsPassedOn) {
  const auto once = smooth(recording(), {});
  ASSERT_TRUE(once);
  const auto same = smooth(once->trajectories, {.method = FilterMethod::none});
  ASSERT_TRUE(same);
  EXPECT_EQ(same->trajectories.filters[1].cutoff_hz, once->trajectories.filters[1].cutoff_hz);
  EXPECT_EQ(before(same->trajectories, 10, 1), before(once->trajectories, 10, 1));
  EXPECT_EQ(same->trajectories.made_by(10, 1), "smoothed by kalman");
}

TEST(HandOn, ASecondFilterIsNamedAfterTheFirstAndKeepsTheFirstsSamples) {
  const auto in = recording();
  const auto once = smooth(in, {});
  const auto twice =
      smooth(once->trajectories, {.method = FilterMethod::butterworth, .order = 2, .cutoff_hz = 5.0});
  ASSERT_TRUE(twice) << twice.error().message;
  EXPECT_EQ(twice->trajectories.filters[0].method, "kalman, butterworth");
  EXPECT_EQ(before(twice->trajectories, 10, 0), Eigen::Vector3d(in.x(10, 0)));
  EXPECT_EQ(twice->trajectories.made_by(10, 0), "smoothed by butterworth");
}

TEST(HandOn, SamplesThatAnUnknownFilterChangedAreNotTakenForUnfilteredOnes) {
  auto once = smooth(recording(), {})->trajectories;
  once.unfiltered_in_world.clear();
  const auto twice = smooth(once, {});
  ASSERT_TRUE(twice);
  EXPECT_TRUE(twice->trajectories.unfiltered_in_world.empty());
  EXPECT_TRUE(std::isnan(twice->trajectories.filters[0].noise_sd_m))
      << "what went into the first is not known";
}

}  // namespace
}  // namespace kinemark::trajectory

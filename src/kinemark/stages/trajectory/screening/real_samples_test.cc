// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/real_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/data/filtering.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;
using data::Trajectories;
using ::testing::HasSubstr;

class RealSamples : public ::testing::Test {
 protected:
  RealSamples() : t(testing::walker({.markers = 3, .frames = 803, .rate_hz = 240.0})) {
    t.time.t0_s = 5.0;
    for (std::int64_t m = 0; m < 3; ++m) testing::interpolate_linearly(t, 4, m == 2 ? 3 : 1, m);
    t.set_missing(401, 0);
    t.set_missing(200, 1, SampleState::rejected);
    t.covariance.assign(6 * t.state.size(), 0.0);
    for (std::size_t i = 0; i < t.covariance.size(); ++i) t.covariance[i] = static_cast<double>(i);
    report = detect_upsampling(t).value();
  }
  Trajectories t;
  data::UpsamplingAccount report;
};

TEST_F(RealSamples, MarkKeepsNumbersAndTellsStatesAndMethod) {
  const Trajectories out = keep_real_samples(t, report, MadeSamples::mark).value();
  ASSERT_TRUE(out.validate());
  EXPECT_EQ(out.frames(), t.frames());
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      const SampleState was = t.state[t.index(f, m)];
      const bool real = f % 4 == (m == 2 ? 3 : 1);
      EXPECT_EQ(out.state[out.index(f, m)],
                was == SampleState::measured && !real ? SampleState::upsampled : was);
      if (t.present(f, m)) {
        EXPECT_EQ(out.x(f, m), t.x(f, m));
      }
    }
  EXPECT_THAT(std::string(out.made_by(2, 0)), HasSubstr("linear x4"));
  EXPECT_EQ(out.made_by(1, 0), "");
}

TEST_F(RealSamples, MissingLeavesRealSamplesOnly) {
  const Trajectories out = keep_real_samples(t, report, MadeSamples::missing).value();
  ASSERT_TRUE(out.validate());
  EXPECT_TRUE(out.present(1, 0));
  EXPECT_FALSE(out.present(2, 0));
  EXPECT_TRUE(out.present(3, 2));
  EXPECT_EQ(out.state[out.index(200, 1)], SampleState::rejected);
}

TEST_F(RealSamples, DecimateGivesTheLowRateAtTrueTimes) {
  const Trajectories low = keep_real_samples(t, report, MadeSamples::decimate).value();
  ASSERT_TRUE(low.validate());
  EXPECT_DOUBLE_EQ(low.time.rate_hz, 60.0);
  EXPECT_EQ(low.frames(), 201);  // 803 frames end before the real sample of marker 2 in the last one
  for (std::int64_t k = 0; k < 200; ++k)
    for (std::int64_t m = 0; m < 3; ++m) {
      const std::int64_t f = 4 * k + (m == 2 ? 3 : 1);
      EXPECT_EQ(low.present(k, m), t.present(f, m));
      EXPECT_NEAR(low.time_s(k, m), t.time_s(f, m), 1e-12);
      if (!t.present(f, m)) continue;
      EXPECT_EQ(low.x(k, m), t.x(f, m));
      EXPECT_EQ(low.covariance[6 * low.index(k, m) + 2], t.covariance[6 * t.index(f, m) + 2]);
    }
  EXPECT_FALSE(low.present(100, 0));  // real sample 401 was lost
  EXPECT_FALSE(low.present(200, 2));
}

TEST_F(RealSamples, WithOnePhaseNoSampleTimesAreNeeded) {
  for (std::int64_t f = 0; f < t.frames(); ++f) t.set_missing(f, 2);
  const auto again = detect_upsampling(t).value();
  const Trajectories low = keep_real_samples(t, again, MadeSamples::decimate).value();
  EXPECT_TRUE(low.sample_offset_s.empty());
  EXPECT_NEAR(low.time.t0_s, 5.0 + 1.0 / 240.0, 1e-12);
}

TEST_F(RealSamples, AnHonestRecordingComesBackAsItIs) {
  const Trajectories honest = testing::walker();
  const auto nothing = detect_upsampling(honest).value();
  for (const MadeSamples made : {MadeSamples::mark, MadeSamples::missing, MadeSamples::decimate}) {
    const Trajectories out = keep_real_samples(honest, nothing, made).value();
    EXPECT_EQ(out.x_in_world, honest.x_in_world);
    EXPECT_EQ(out.state, honest.state);
    EXPECT_EQ(out.time, honest.time);
  }
}

TEST_F(RealSamples, SingleMarkersCannotBeDecimated) {
  Trajectories mixed = testing::walker({.markers = 4, .frames = 900});
  testing::interpolate_linearly(mixed, 3, 0, 1);
  const auto found = detect_upsampling(mixed).value();
  const auto low = keep_real_samples(mixed, found, MadeSamples::decimate);
  ASSERT_FALSE(low);
  EXPECT_EQ(low.error().code, Code::not_supported);
  EXPECT_THAT(low.error().message, HasSubstr("'M1'"));
  EXPECT_TRUE(keep_real_samples(mixed, found, MadeSamples::mark));
}

TEST_F(RealSamples, AReportOfAnotherRecordingIsRefused) {
  EXPECT_EQ(keep_real_samples(testing::walker(), report, MadeSamples::mark).error().code, Code::bad_input);
}

TEST_F(RealSamples, SamplesThatSomebodyElseMadeKeepTheirName) {
  t.state[t.index(10, 0)] = SampleState::model_filled;
  t.set_method(10, 0, "rigid body");
  const Trajectories out = keep_real_samples(t, report, MadeSamples::mark).value();
  EXPECT_EQ(out.state[out.index(10, 0)], SampleState::model_filled);
  EXPECT_EQ(out.made_by(10, 0), "rigid body");
}

TEST_F(RealSamples, WhatTheRecorderMadeWasNotMeasuredBeforeAFilterEither) {
  t.filters.assign(3, {.method = "kalman", .order = 4, .cutoff_hz = 6.0, .noise_sd_m = 1e-4});
  t.unfiltered_in_world = t.x_in_world;
  for (std::int64_t m = 0; m < 3; ++m) data::mark_smoothed(t, m, "kalman");
  for (const MadeSamples made : {MadeSamples::mark, MadeSamples::missing, MadeSamples::decimate}) {
    const Trajectories out = keep_real_samples(t, report, made).value();
    ASSERT_TRUE(out.validate()) << out.validate().error().message;
    EXPECT_EQ(out.filters.size(), 3U);
    ASSERT_EQ(out.unfiltered_in_world.size(), out.x_in_world.size());
    for (std::size_t i = 0; i < out.state.size(); ++i)
      if (out.state[i] == SampleState::measured)
        EXPECT_EQ(out.unfiltered_in_world[3 * i], out.x_in_world[3 * i]) << i;
      else
        EXPECT_TRUE(std::isnan(out.unfiltered_in_world[3 * i])) << i;
  }
}

}  // namespace
}  // namespace kinemark::trajectory

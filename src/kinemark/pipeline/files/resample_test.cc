// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/index.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A circle of 0.2 m, once a second.
Eigen::Vector3d place(double time_s) {
  const double phase = 2.0 * std::numbers::pi * time_s;
  return {0.2 * std::cos(phase), 0.2 * std::sin(phase), 1.0 + 0.1 * time_s};
}

data::Trial circle(double rate_hz, std::int64_t frames, double t0_s = 0.0) {
  data::Trial t;
  t.first_frame = std::llround(t0_s * rate_hz) + 1;
  t.markers =
      data::Trajectories::all_missing({"A", "B"}, {.rate_hz = rate_hz, .t0_s = t0_s, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      t.markers.x(f, m) = place(t.markers.time.time_s(f));
      t.markers.state[t.markers.index(f, m)] = data::SampleState::measured;
    }
  return t;
}

TEST(Resample, BetweenFramesIsTheSpline) {
  auto t = circle(100.0, 101, 2.0);
  ASSERT_TRUE(resample(t, 240.0));
  EXPECT_EQ(t.markers.time, (TimeBase{240.0, 2.0, 241}));
  EXPECT_EQ(t.first_frame, 481);
  ASSERT_TRUE(t.validate()) << t.validate().error().message;
  EXPECT_THAT(t.warnings, IsEmpty());
  for (std::int64_t i = 0; i < 241; ++i) {
    const bool same = i % 12 == 0;  // 5 old frames are 12 new ones
    const double edge = i < 24 || i > 216 ? 2e-6 : 1e-7;
    EXPECT_LT((t.markers.x(i, 0) - place(t.markers.time.time_s(i))).norm(), same ? 1e-12 : edge) << i;
    EXPECT_EQ(t.markers.state[t.markers.index(i, 0)],
              same ? data::SampleState::measured : data::SampleState::interpolated);
    EXPECT_EQ(t.markers.made_by(i, 0), same ? "" : "resampled");
  }
}

TEST(Resample, TheSameRateAndWholeFractionsChangeNoBit) {
  auto t = circle(100.0, 50);
  const auto before = t;
  ASSERT_TRUE(resample(t, 100.0));
  EXPECT_EQ(t.markers.x_in_world, before.markers.x_in_world);
  EXPECT_EQ(t.markers.state, before.markers.state);
  EXPECT_THAT(t.warnings, Not(Contains(HasSubstr("resampled without a filter: what moves faster"))));
  ASSERT_TRUE(resample(t, 25.0));
  EXPECT_EQ(t.markers.frames(), 13);
  for (std::int64_t i = 0; i < 13; ++i) EXPECT_EQ(t.markers.x(i, 1), before.markers.x(4 * i, 1));
  EXPECT_THAT(t.markers.methods, IsEmpty());
  EXPECT_THAT(t.warnings,
              Contains(HasSubstr("resampled without a filter: what moves faster than 12.5 Hz is folded")));
}

TEST(Resample, GapsStayGaps) {
  auto t = circle(100.0, 40);
  for (std::int64_t f = 10; f < 20; ++f) t.markers.set_missing(f, 1);
  t.markers.set_missing(30, 1, data::SampleState::rejected);
  t.markers.set_missing(32, 1);
  ASSERT_TRUE(resample(t, 200.0));
  for (std::int64_t i = 0; i < t.markers.frames(); ++i) {
    const double f = 0.5 * static_cast<double>(i);
    const bool gap = (f > 9.0 && f < 20.0) || (f > 29.0 && f < 31.0) || (f > 31.0 && f < 33.0);
    EXPECT_EQ(t.markers.present(i, 1), !gap) << f;
    EXPECT_TRUE(t.markers.present(i, 0));
  }
  EXPECT_EQ(t.markers.state[t.markers.index(60, 1)], data::SampleState::rejected);
  EXPECT_EQ(t.markers.state[t.markers.index(62, 1)], data::SampleState::measured)
      << "a single sample between gaps";
  EXPECT_TRUE(t.validate());
}

TEST(Resample, DeviationsLieBetweenThoseOfTheNeighbours) {
  auto t = circle(100.0, 3);
  t.markers.covariance.assign(36, 0.0);
  for (std::int64_t f = 0; f < 3; ++f)
    t.markers.covariance[6 * t.markers.index(f, 0)] = 1.0 + static_cast<double>(f);
  t.residual_m.assign(6, 2.0F);
  t.camera_mask.assign(6, 3);
  ASSERT_TRUE(resample(t, 400.0));
  for (std::int64_t i = 0; i < 9; ++i) {
    const auto j = t.markers.index(i, 0);
    EXPECT_NEAR(t.markers.covariance[6 * j], 1.0 + 0.25 * static_cast<double>(i), 1e-12);
    EXPECT_EQ(std::isfinite(t.residual_m[j]), i % 4 == 0) << "a residual belongs to a measurement";
    EXPECT_EQ(t.camera_mask[j], i % 4 == 0 ? 3 : 0);
  }
  EXPECT_TRUE(t.validate());
}

TEST(Resample, ChannelsFollowAndAnglesDoNotPassTheWrongWay) {
  auto t = circle(10.0, 5);
  t.channels = {.names = {"knee", "force"},
                .kinds = {data::ChannelKind::angle, data::ChannelKind::force},
                .units = {"deg", "N"},
                .rate_hz = 10.0,
                .frames = 5};
  for (const double v : {170.0, 175.0, -180.0, -175.0, -170.0})
    for (int k = 0; k < 6; ++k)
      t.channels.values.push_back(k == 4 ? std::numeric_limits<double>::quiet_NaN() : v);
  ASSERT_TRUE(resample(t, 20.0));
  const auto value = [&](std::int64_t i, std::int64_t c) { return t.channels.values[at(i * 6 + c)]; };
  EXPECT_NEAR(value(1, 0), 172.5, 1e-9);
  EXPECT_TRUE(std::isnan(value(3, 0))) << "from 175 to -180 degrees";
  EXPECT_NEAR(value(5, 0), -177.5, 1e-9);
  EXPECT_TRUE(std::isfinite(value(3, 3))) << "a force has no other way round";
  EXPECT_TRUE(std::isnan(value(2, 4)));
  EXPECT_TRUE(t.validate());
}

TEST(Resample, AnalogSamplesKeepTheirRateOrAreLeftOut) {
  const auto with_analog = [] {
    auto t = circle(100.0, 11);
    t.analog = {.names = {"Fz"}, .units = {"N"}, .rate_hz = 1000.0, .samples = 110};
    for (int s = 0; s < 110; ++s) t.analog.values.push_back(s);
    t.force_plates = {{.type = 2, .channel_idx = {0}}};
    return t;
  };
  auto kept = with_analog();
  ASSERT_TRUE(resample(kept, 50.0));
  EXPECT_EQ(kept.markers.frames(), 5) << "120 samples are needed for 6 frames, and there are 110";
  EXPECT_EQ(kept.analog.samples, 100);
  EXPECT_THAT(kept.warnings, Contains("the last frame is left out: its analog samples are not all there"));
  EXPECT_THAT(kept.warnings, Not(Contains(HasSubstr("frames are left out: their analog samples"))));
  kept = with_analog();
  kept.analog.samples = 60;
  kept.analog.values.resize(60);
  ASSERT_TRUE(resample(kept, 50.0));
  EXPECT_EQ(kept.markers.frames(), 3);
  EXPECT_THAT(kept.warnings,
              Contains("the last 3 frames are left out: their analog samples are not all there"));
  EXPECT_THAT(kept.warnings, Not(Contains(HasSubstr("the last frame is left out: its"))));
  kept = with_analog();
  ASSERT_TRUE(resample(kept, 500.0));
  EXPECT_THAT(kept.warnings, Not(Contains(HasSubstr("left out: no whole number of samples fits"))));
  EXPECT_THAT(kept.warnings, Not(Contains(HasSubstr("the last frame is left out: its"))));
  EXPECT_EQ(kept.markers.frames(), 51);
  EXPECT_EQ(kept.analog.samples, 102);
  EXPECT_EQ(kept.analog.values.back(), 101.0);
  EXPECT_TRUE(kept.validate());
  auto lost = with_analog();
  ASSERT_TRUE(resample(lost, 120.0));
  EXPECT_THAT(lost.force_plates, IsEmpty());
  EXPECT_THAT(lost.warnings,
              Contains("1 analog channel at 1000 Hz and 1 force plate left out: no whole number of "
                       "samples fits a frame at 120 Hz"));
}

TEST(Resample, WhatCannotBeDoneIsRefused) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const double rate : {none, 0.0, -5.0, 0.01, 1e9}) {
    auto t = circle(100.0, 3);
    EXPECT_EQ(resample(t, rate).error().code, Code::usage) << rate;
  }
  auto t = circle(100.0, 3000);
  EXPECT_THAT(resample(t, 9e7).error().message, HasSubstr("need fewer than 2^31 samples"));
  t.markers.sample_offset_s.assign(2, 1e-3);
  EXPECT_THAT(resample(t, 200.0).error().message, HasSubstr("times of their own"));
}

TEST(Resample, SamplesFromBeforeAFilterStayWhereTheyWereMeasured) {
  auto t = circle(100.0, 11);
  t.markers.filters.assign(2, {.method = "kalman", .order = 4, .cutoff_hz = 6.0, .noise_sd_m = 1e-4});
  t.markers.unfiltered_in_world = t.markers.x_in_world;
  for (double& v : t.markers.unfiltered_in_world) v += 1e-3;
  const auto before = t.markers;
  ASSERT_TRUE(resample(t, 200.0));
  ASSERT_TRUE(t.validate()) << t.validate().error().message;
  EXPECT_EQ(t.markers.filters.size(), 2U);
  for (std::int64_t i = 0; i < t.markers.frames(); ++i) {
    const double x = t.markers.unfiltered_in_world[3 * t.markers.index(i, 1)];
    if (i % 2 == 0)
      EXPECT_EQ(x, before.unfiltered_in_world[3 * before.index(i / 2, 1)]) << i;
    else
      EXPECT_TRUE(std::isnan(x)) << i;
  }
}

}  // namespace
}  // namespace kinemark::pipeline

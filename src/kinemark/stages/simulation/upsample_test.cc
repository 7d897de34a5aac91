// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/upsample.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::simulation {
namespace {

using data::SampleState;

/// One marker along x = t^2, y = 3 t, z = 1 (m, t in frames).
data::Trajectories parabola(std::int64_t frames) {
  auto out = data::Trajectories::all_missing({"a"}, {60.0, 0.5, frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto t = static_cast<double>(f);
    out.x(f, 0) << t * t, 3.0 * t, 1.0;
    out.state[out.index(f, 0)] = SampleState::measured;
  }
  return out;
}

TEST(Upsample, KeepsEveryFourthFrameAndTheTime) {
  const auto in = parabola(6);
  const auto out = upsample(in).value();
  ASSERT_TRUE(out.validate());
  EXPECT_EQ(out.frames(), 21);
  EXPECT_EQ(out.time.rate_hz, 240.0);
  for (std::int64_t f = 0; f < 6; ++f) {
    EXPECT_EQ(out.x(4 * f, 0), in.x(f, 0));
    EXPECT_DOUBLE_EQ(out.time.time_s(4 * f), in.time.time_s(f));
  }
  EXPECT_DOUBLE_EQ(out.x(5, 0).x(), 1.75);  // a quarter of the way from 1 to 4
  EXPECT_EQ(out.count_missing(), 0);
}

TEST(Upsample, CubicFollowsAParabolaBetweenItsEnds) {
  const auto out = upsample(parabola(6), {.factor = 4, .how = Upsampling::cubic}).value();
  for (std::int64_t f = 4; f <= 16; ++f) {
    const double t = static_cast<double>(f) / 4.0;
    EXPECT_NEAR(out.x(f, 0).x(), t * t, 1e-12);
    EXPECT_NEAR(out.x(f, 0).y(), 3.0 * t, 1e-12);
  }
  EXPECT_GT(std::abs(out.x(2, 0).x() - 0.25), 1e-3);  // one neighbour is missing there
  EXPECT_NEAR(out.x(2, 0).y(), 1.5, 1e-12);
}

TEST(Upsample, MakesNothingBesideAGap) {
  auto in = parabola(6);
  in.set_missing(3, 0);
  for (const auto how : {Upsampling::linear, Upsampling::cubic}) {
    const auto out = upsample(in, {.factor = 4, .how = how, .tell = true}).value();
    ASSERT_TRUE(out.validate());
    EXPECT_EQ(out.count_missing(), 7);  // frames 9 to 15
    EXPECT_TRUE(out.present(8, 0));
    EXPECT_TRUE(out.present(16, 0));
    EXPECT_EQ(out.state[out.index(7, 0)], SampleState::upsampled);
    EXPECT_EQ(out.state[out.index(8, 0)], SampleState::measured);
  }
}

TEST(Upsample, AStreamThatTellsNothingCallsAllMeasured) {
  const auto out = upsample(parabola(3)).value();
  for (const auto state : out.state) EXPECT_EQ(state, SampleState::measured);
  EXPECT_EQ(upsample(parabola(3), {.factor = 1}).value().x_in_world, parabola(3).x_in_world);
}

TEST(Upsample, RefusesAFactorOutOfRangeAndNoFrames) {
  EXPECT_EQ(upsample(parabola(3), {.factor = 0}).error().code, Code::usage);
  EXPECT_EQ(upsample(parabola(3), {.factor = 101}).error().code, Code::usage);
  EXPECT_EQ(upsample(parabola(0)).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::simulation

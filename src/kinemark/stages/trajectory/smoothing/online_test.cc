// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/online.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "support/allocations.h"

namespace kinemark::trajectory {
namespace {

using data::Trajectories;
using ::testing::HasSubstr;

/// Two markers with short gaps, a long one, and missing ends.
Trajectories recording(int frames) {
  Trajectories t = Trajectories::all_missing({"A", "B"}, {100.0, 0.0, frames});
  Random random(4, 2);
  for (int m = 0; m < 2; ++m) {
    for (int f = 0; f < frames; ++f) {
      const bool lost =
          f < 3 || (f >= 60 && f < 66) || (m == 1 && f >= 150 && f < 290) || random.uniform() < 0.03;
      Eigen::Vector3d x;
      for (int axis = 0; axis < 3; ++axis)
        x[axis] = 0.3 * std::sin(0.08 * f + axis + m) + 0.0005 * random.gaussian();
      if (lost || f >= frames - 4) continue;
      t.x(f, m) = x;
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  }
  return t;
}

std::span<const double> frame_of(const Trajectories& t, std::int64_t frame) {
  return {t.x_in_world.data() + 3 * t.index(frame, 0), static_cast<std::size_t>(3 * t.markers())};
}

TEST(OnlineTrajectorySmoother, EqualsTheOfflineSmootherWhenItWaitsForAll) {
  constexpr int kFrames = 400;
  const Trajectories in = recording(kFrames);
  for (int order = 2; order <= 5; ++order) {
    SmoothOptions offline;
    offline.order = order;
    offline.cutoff_hz = 6.0;
    offline.noise_sd_m = 0.0005;
    offline.max_bridge_s = 10.0;
    offline.max_bridge_sd_m = 1e6;
    const auto expected = smooth(in, offline).value();
    auto online = OnlineTrajectorySmoother::create(2, 100.0, {order, 6.0, 0.0005, kFrames, true}).value();
    for (int f = 0; f < kFrames; ++f) ASSERT_FALSE(online.push(frame_of(in, f)));
    for (int f = 0; f < kFrames; ++f) {
      const auto out = online.drain();
      ASSERT_TRUE(out);
      EXPECT_EQ(out->frame, f);
      const auto compare = [&](std::span<const double> found, const Array<double>& all, double unit) {
        for (std::size_t i = 0; i < 6; ++i) {
          const double truth = all[static_cast<std::size_t>(f) * 6 + i];
          ASSERT_EQ(std::isnan(found[i]), std::isnan(truth)) << "order " << order << " frame " << f;
          if (!std::isnan(truth)) {
            ASSERT_NEAR(found[i] / unit, truth / unit, 1e-9) << order << " " << f;
          }
        }
      };
      compare(out->x, expected.trajectories.x_in_world, 1.0);
      compare(out->velocity, expected.derivatives.velocity, 10.0);
      compare(out->acceleration, expected.derivatives.acceleration, 100.0);
    }
    EXPECT_FALSE(online.drain());
  }
}

TEST(OnlineTrajectorySmoother, EachFrameUsesTheLagAndNoMore) {
  // At a lag of L, frame f must be the last but L of an offline run over frames up to f + L.
  constexpr int kLag = 9;
  const Trajectories in = recording(200);
  auto online = OnlineTrajectorySmoother::create(2, 100.0, {4, 6.0, 0.0005, kLag, false}).value();
  SmoothOptions offline;
  offline.order = 4;
  offline.cutoff_hz = 6.0;
  offline.noise_sd_m = 0.0005;
  for (int f = 0; f < 200; ++f) {
    const auto out = online.push(frame_of(in, f));
    ASSERT_EQ(out.has_value(), f >= kLag);
    if (f % 23 != 0 || !out) continue;
    Trajectories until = in;
    for (int later = f + 1; later < 200; ++later)
      for (int m = 0; m < 2; ++m) until.set_missing(later, m);
    const auto expected = smooth(until, offline).value();
    EXPECT_EQ(out->frame, f - kLag);
    for (std::size_t i = 0; i < 6; ++i) {
      const double truth = expected.derivatives.velocity[static_cast<std::size_t>(f - kLag) * 6 + i];
      ASSERT_EQ(std::isnan(out->velocity[i]), std::isnan(truth));
      if (!std::isnan(truth)) {
        EXPECT_NEAR(out->velocity[i], truth, 1e-8);
      }
    }
  }
}

TEST(OnlineTrajectorySmoother, StandardDeviationsHaveSettledToTheFormula) {
  // Long after the start: sd^2 of position = sigma^2 w dt / (2 m sin(pi / 2 m)) for a lag without end.
  auto online = OnlineTrajectorySmoother::create(1, 1000.0, {4, 6.0, 0.001, 1500, false}).value();
  const std::vector<double> still{0.1, 0.2, 0.3};
  std::optional<OnlineFrame> out;
  for (int f = 0; f < 3001; ++f) out = online.push(still);
  ASSERT_TRUE(out);
  const double corner = 2.0 * M_PI * 6.0 / std::pow(std::sqrt(2.0) - 1.0, 1.0 / 8.0);
  EXPECT_NEAR(out->sd[0], 0.001 * std::sqrt(corner * 0.001 / (8.0 * std::sin(M_PI / 8.0))), 1e-7);
  EXPECT_NEAR(out->x[1], 0.2, 1e-9);
  EXPECT_NEAR(out->acceleration[1], 0.0, 1e-6);
}

TEST(OnlineTrajectorySmoother, AllocatesNothingPerFrame) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const Trajectories in = recording(300);
  auto online = OnlineTrajectorySmoother::create(2, 100.0, {5, 8.0, 0.0005, 20, true}).value();
  const auto before = testing_support::allocations_on_this_thread();
  for (int f = 0; f < 300; ++f) (void)online.push(frame_of(in, f));
  while (online.drain()) {
  }
  EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
}

TEST(OnlineTrajectorySmoother, MissingStaysMissing) {
  const Trajectories in = recording(200);
  auto online = OnlineTrajectorySmoother::create(2, 100.0, {4, 6.0, 0.0005, 0, false}).value();
  for (int f = 0; f < 200; ++f) {
    const auto out = online.push(frame_of(in, f));
    ASSERT_TRUE(out);
    for (int m = 0; m < 2; ++m)
      EXPECT_EQ(std::isfinite(out->x[static_cast<std::size_t>(3 * m)]), in.present(f, m)) << f;
  }
}

TEST(OnlineTrajectorySmoother, RefusesWhatItCannotDo) {
  const auto message = [](std::int64_t markers, double rate, const OnlineOptions& options) {
    const auto made = OnlineTrajectorySmoother::create(markers, rate, options);
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_THAT(message(1, 100.0, {6, 6.0, 0.001, 5, false}), HasSubstr("order is 6"));
  EXPECT_THAT(message(1, 100.0, {4, 50.0, 0.001, 5, false}), HasSubstr("half of the rate"));
  EXPECT_THAT(message(1, 100.0, {4, 6.0, 0.0, 5, false}), HasSubstr("noise_sd_m is 0"));
  EXPECT_THAT(message(1, 100.0, {4, 6.0, 0.001, -1, false}), HasSubstr("lag_frames is -1"));
  EXPECT_THAT(message(1, std::nan(""), {}), HasSubstr("rate_hz"));
  EXPECT_THAT(message(-1, 100.0, {}), HasSubstr("markers is -1"));
  auto online = OnlineTrajectorySmoother::create(2, 100.0, {}).value();
  EXPECT_THROW((void)online.push(std::vector<double>(5, 0.0)), ContractError);
}

}  // namespace
}  // namespace kinemark::trajectory

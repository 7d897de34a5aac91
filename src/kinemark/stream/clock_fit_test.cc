// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/clock_fit.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::stream {
namespace {

/// How frames of a clock that is fast come: late by an exponential delay, and sometimes very late.
struct Arrivals {
  double rate_hz = 138.0, ppm = 300.0, seconds = 60.0, delay_s = 1e-3, least_s = 60e-6, stall_share = 0.002;
};

void feed(ClockFit& fit, const Arrivals& a, std::uint64_t seed, std::int64_t first = 0,
          std::int64_t begin_ns = 7'000'000'000) {
  Random random(seed, 0);
  double before_s = 0.0;
  const double rate_hz = a.rate_hz * (1.0 + 1e-6 * a.ppm);
  for (std::int64_t f = 1; f <= std::llround(a.seconds * a.rate_hz); ++f) {
    double late_s = a.least_s - a.delay_s * std::log(1.0 - random.uniform());
    if (random.uniform() < a.stall_share) late_s += 0.5 * random.uniform();
    before_s = std::max(before_s + 1e-6, static_cast<double>(f) / rate_hz + late_s);
    fit.add(first + f, begin_ns + std::llround(1e9 * before_s));
  }
}

TEST(ClockFit, FindsAClockThatIsFastWithinItsBars) {
  int within = 0;
  double worst_ppm = 0.0, squares = 0.0;
  constexpr int kTrials = 50;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    ClockFit fit(138.0);
    feed(fit, {}, seed);
    const auto rate = fit.rate().value();
    const double off = rate.ppm_fast - 300.0;
    worst_ppm = std::max(worst_ppm, std::abs(off));
    within += std::abs(off) < 2.0 * rate.sd_ppm;
    squares += off * off / (rate.sd_ppm * rate.sd_ppm) / kTrials;
    EXPECT_NEAR(rate.rate_hz, 138.0 * 1.0003, 138e-6);
    EXPECT_NEAR(rate.sd_hz, 138e-6 * rate.sd_ppm, 1e-9);
    EXPECT_NEAR(rate.span_s, 60.0, 0.6);
  }
  EXPECT_LT(worst_ppm, 1.0);
  EXPECT_GE(within, 42);
  EXPECT_GT(squares, 0.4);
  EXPECT_LT(squares, 1.7);
}

TEST(ClockFit, ALongRecordingTakesNoMoreMemoryAndIsBetter) {
  ClockFit fit(100.0);
  feed(fit, {.rate_hz = 100.0, .ppm = -42.0, .seconds = 3600.0}, 5);
  const auto rate = fit.rate().value();
  EXPECT_NEAR(rate.ppm_fast, -42.0, 0.02);
  EXPECT_LT(rate.sd_ppm, 0.01);
}

TEST(ClockFit, AHostThatSleptTenSecondsMattersLittle) {
  ClockFit fit(138.0);
  feed(fit, {.seconds = 30.0}, 3);
  // Frames of the next ten seconds were lost, or came at once at the end of them.
  fit.add(138 * 40, 7'000'000'000 + 40'200'000'000);
  feed(fit, {.seconds = 20.0}, 4, 138 * 40, 7'000'000'000 + std::llround(40e9 / 1.0003));
  EXPECT_NEAR(fit.rate()->ppm_fast, 300.0, 1.0);
}

TEST(ClockFit, APluggedInDeviceIsNumberedAnewAndTheLongerPartCounts) {
  ClockFit fit(138.0);
  feed(fit, {}, 3);
  fit.restart();
  EXPECT_NEAR(fit.rate()->ppm_fast, 300.0, 1.0);
  feed(fit, {.ppm = 200.0, .seconds = 10.0}, 4, 20'000, 200'000'000'000);
  EXPECT_NEAR(fit.rate()->ppm_fast, 300.0, 1.0);
  fit.restart();
  feed(fit, {.ppm = 200.0, .seconds = 90.0}, 5, 30'000, 400'000'000'000);
  EXPECT_NEAR(fit.rate()->ppm_fast, 200.0, 1.0);
}

TEST(ClockFit, SaysNothingOfTheFirstMoments) {
  ClockFit fit(138.0);
  EXPECT_FALSE(fit.rate());
  feed(fit, {.seconds = 1.0}, 1);
  EXPECT_FALSE(fit.rate());
  ClockFit slow(0.1);
  feed(slow, {.rate_hz = 0.1, .seconds = 100.0}, 1);
  EXPECT_NEAR(slow.rate()->ppm_fast, 300.0, 100.0);
}

}  // namespace
}  // namespace kinemark::stream

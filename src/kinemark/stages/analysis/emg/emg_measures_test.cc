// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/emg_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using data::IntervalKind;
using data::Measure;
using Eigen::VectorXd;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kEmg_hz = 1000.0;
constexpr double kStrong = 1e-3, kQuiet = 2e-5;

/// Band-passed white noise, of a muscle that is active from 1.5 to 2.5 s of 4 s.
EmgChannel burst(std::uint64_t seed, double strength = kStrong) {
  Random random(seed, 0);
  VectorXd white(4000);
  for (double& x : white) x = random.gaussian();
  VectorXd band = band_passed(white, kEmg_hz, {.low_pass_hz = 300.0});
  band /= std::sqrt(band.squaredNorm() / 4000.0);
  for (int i = 0; i < 4000; ++i) {
    const double active = i >= 1500 && i < 2500 ? strength : 0.0;
    band[i] *= std::sqrt(active * active + kQuiet * kQuiet);
  }
  return {.name = "EMG1", .volts = band.array() + 0.02};
}

const Measure& get(const EmgMeasures& out, const std::string& id, const std::string& region = "") {
  static const Measure none{};
  for (const auto& m : out.measures)
    if (m.id == id && m.region == region) return m;
  ADD_FAILURE() << id << " is not there";
  return none;
}

TEST(EmgMeasures, ABurstIsFoundAndMeasured) {
  const auto out = measure_emg({burst(3)}, kEmg_hz, 10.0, {.refits = 0}).value();
  EXPECT_NEAR(get(out, "emg_rms").value, kStrong * 0.5, 0.05 * kStrong)
      << "a quarter of the time at full power";
  EXPECT_NEAR(get(out, "emg_active").value, 0.25, 0.06);
  EXPECT_NEAR(get(out, "emg_onset").value, 1.5, 0.1);
  EXPECT_NEAR(get(out, "emg_end").value, 2.5, 0.1);
  EXPECT_LT(get(out, "emg_rest").value, 3.0 * kQuiet);
  EXPECT_EQ(get(out, "emg_mean").start_s, 10.0);
  EXPECT_THAT(get(out, "emg_mean").method, HasSubstr("20 to 450 Hz, envelope 6 Hz"));
  ASSERT_EQ(out.envelopes.size(), 1u);
  EXPECT_EQ(out.envelopes[0].size(), 4000);
  for (const auto& m : out.measures) EXPECT_TRUE(m.validate()) << m.id;
}

TEST(EmgMeasures, IntervalsHoldTheStrengthOfTheMuscle) {
  const EmgOptions options{.measures = {"emg_rms", "emg_mean"},
                           .stretches = {{.name = "on", .first = 1600, .count = 800}},
                           .refits = 39};
  int rms = 0, mean = 0;
  constexpr int kTrials = 10;
  const double rectified = kStrong * std::sqrt(2.0 / M_PI);
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto out =
        measure_emg({burst(50 + static_cast<std::uint64_t>(trial))}, kEmg_hz, 0.0, options).value();
    const auto &r = get(out, "emg_rms", "on"), &m = get(out, "emg_mean", "on");
    ASSERT_EQ(r.interval.kind, IntervalKind::two_sided);
    EXPECT_TRUE(r.interval.approximate);
    rms += r.interval.low <= kStrong && kStrong <= r.interval.high;
    mean += m.interval.low <= rectified && rectified <= m.interval.high;
    EXPECT_LT(r.interval.high - r.interval.low, 0.5 * kStrong);
  }
  EXPECT_GE(rms, 8);
  EXPECT_GE(mean, 8);
}

TEST(EmgMeasures, TheMedianFrequencyKeepsTheChanceOfItsStretchOnce) {
  Random random(5, 7);
  VectorXd longer(64000);
  for (double& x : longer) x = random.gaussian();
  const double truth = median_frequency(band_passed(longer, kEmg_hz, {.low_pass_hz = 300.0}), kEmg_hz);
  int inside = 0;
  double freed = 0.0, found = 0.0;
  constexpr int kTrials = 12;
  for (int k = 0; k < kTrials; ++k) {
    const auto out = measure_emg({burst(40 + static_cast<std::uint64_t>(k))}, kEmg_hz, 0.0,
                                 {.measures = {"emg_median_frequency"},
                                  .stretches = {{.name = "burst", .first = 1500, .count = 1000}},
                                  .refits = 39})
                         .value();
    const auto& m = get(out, "emg_median_frequency", "burst");
    inside += m.interval.low <= truth && truth <= m.interval.high;
    freed += std::pow(m.value - truth, 2), found += std::pow(m.uncorrected - truth, 2);
  }
  EXPECT_GE(inside, 9);
  EXPECT_LT(freed, 1.4 * found);
}

TEST(EmgMeasures, WithoutABurstNothingIsFreedOfABias) {
  const EmgOptions options{.stretches = {{.name = "before", .first = 0, .count = 1200}, {.count = 4000}},
                           .refits = 39};
  const auto loud = measure_emg({burst(5)}, kEmg_hz, 0.0, options).value();
  for (const std::string id : {"emg_mean", "emg_peak", "emg_rms", "emg_median_frequency", "emg_active"}) {
    const auto& m = get(loud, id, "before");
    EXPECT_EQ(m.value, m.uncorrected) << id;
    EXPECT_EQ(m.interval.kind, IntervalKind::none) << id;
    EXPECT_THAT(m.remark, HasSubstr("no burst rises above rest")) << id;
  }
  EXPECT_EQ(get(loud, "emg_active", "before").value, 0.0);
  EXPECT_EQ(get(loud, "emg_mean").interval.kind, IntervalKind::two_sided);
}

TEST(EmgMeasures, AStrengthThatNeverChangesIsNeitherRestNorActivity) {
  // Never active, and active throughout.
  for (const bool active : {false, true}) {
    auto channel = burst(5, 0.0);
    if (active) channel.volts *= 30.0;
    const auto out = measure_emg({channel}, kEmg_hz, 0.0, {.refits = 39}).value();
    for (const std::string id : {"emg_onset", "emg_end", "emg_active", "emg_rest"}) {
      EXPECT_TRUE(std::isnan(get(out, id).value)) << id;
      EXPECT_THAT(get(out, id).remark, HasSubstr("its strength hardly changes")) << id;
    }
    const auto& rms = get(out, "emg_rms");
    EXPECT_NEAR(rms.value, (active ? 30.0 : 1.0) * kQuiet, 0.1 * rms.value);
    EXPECT_EQ(rms.interval.kind, IntervalKind::at_most);
    EXPECT_THAT(rms.remark, HasSubstr("with what the channel has at rest, which is not known"));
    EXPECT_EQ(get(out, "emg_peak").interval.kind, IntervalKind::at_most);
  }
  const auto out = measure_emg({burst(5)}, kEmg_hz, 0.0, {.refits = 39}).value();
  for (const auto& m : out.measures) {
    EXPECT_THAT(m.remark, Not(HasSubstr("its strength hardly changes"))) << m.id;
    EXPECT_THAT(m.remark, Not(HasSubstr("no part of the channel is surely at rest"))) << m.id;
    EXPECT_THAT(m.remark, Not(HasSubstr("which is not known"))) << m.id;
  }
}

TEST(EmgMeasures, AModulatedStrengthHasNoRest) {
  auto channel = burst(6, 0.0);
  for (int i = 0; i < 4000; ++i)
    channel.volts[i] = (channel.volts[i] - 0.02) * (1.0 + 0.75 * std::sin(2.0 * M_PI * 1.3 * i / kEmg_hz));
  const auto out = measure_emg({channel}, kEmg_hz, 0.0, {.refits = 39}).value();
  EXPECT_TRUE(std::isnan(get(out, "emg_active").value));
  EXPECT_THAT(get(out, "emg_active").remark, HasSubstr("no part of the channel is surely at rest"));
  EXPECT_NEAR(get(out, "emg_rms").value, std::sqrt(1.0 + 0.5 * 0.75 * 0.75) * kQuiet, 0.15 * kQuiet)
      << "of all of it";
}

TEST(EmgMeasures, ATremorHasNoRest) {
  // Five times a second: never silent, and silent for a tenth of a second.
  for (const bool silent : {false, true}) {
    auto channel = burst(6, 0.0);
    for (int i = 0; i < 4000; ++i) {
      const double wave = std::sin(2.0 * M_PI * 5.0 * i / kEmg_hz);
      channel.volts[i] =
          (channel.volts[i] - 0.02) * (silent ? 0.05 + std::max(0.0, wave) : 0.55 + 0.45 * wave);
    }
    const auto out = measure_emg({channel}, kEmg_hz, 0.0, {.refits = 39}).value();
    for (const std::string id : {"emg_onset", "emg_end", "emg_active", "emg_rest"}) {
      EXPECT_TRUE(std::isnan(get(out, id).value)) << id << silent;
      EXPECT_THAT(get(out, id).remark, HasSubstr("no part of the channel is surely at rest")) << silent;
    }
  }
}

TEST(EmgMeasures, TheShareOfOneBurstIsHeld) {
  int inside = 0;
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    const auto out =
        measure_emg({burst(seed, 10.0 * kQuiet)}, kEmg_hz, 0.0, {.measures = {"emg_active", "emg_rest"}})
            .value();
    const auto& m = get(out, "emg_active");
    inside += m.interval.low <= 0.25 && 0.25 <= m.interval.high;
    EXPECT_NEAR(m.value, 0.25, 0.01);
    EXPECT_LT(m.interval.high - m.interval.low, 0.03);
    const auto& rest = get(out, "emg_rest");
    EXPECT_NEAR(rest.value, std::sqrt(2.0 / M_PI) * kQuiet, 5.0 * rest.sd);
  }
  EXPECT_GE(inside, 10);
}

/// Nine bursts of 120 ms in 6 s, beside rest of a twentieth.
EmgChannel short_bursts(std::uint64_t seed, double& mean) {
  Random random(seed, 4);
  VectorXd white(6000);
  for (double& x : white) x = random.gaussian();
  VectorXd band = band_passed(white, kEmg_hz, {.high_pass_hz = 40.0, .low_pass_hz = 200.0});
  band /= std::sqrt(band.squaredNorm() / 6000.0);
  mean = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const double active = i % 600 >= 300 && i % 600 < 420 && i < 5600 ? kStrong : 0.0;
    const double strength = std::hypot(active, 0.05 * kStrong);
    band[i] *= strength;
    mean += std::sqrt(2.0 / M_PI) * strength / 6000.0;
  }
  return {.name = "EMG1", .volts = band};
}

TEST(EmgMeasures, MeansOfShortBurstsAndOfRestBetweenThemAreHeld) {
  int means = 0, rests = 0;
  constexpr int kTrials = 12;
  const double quiet = 0.05 * kStrong * std::sqrt(2.0 / M_PI);
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    double truth = 0.0;
    const auto out = measure_emg({short_bursts(seed, truth)}, kEmg_hz, 0.0,
                                 {.measures = {"emg_mean", "emg_rest"}, .refits = 39})
                         .value();
    const auto &mean = get(out, "emg_mean"), &rest = get(out, "emg_rest");
    EXPECT_EQ(mean.value, mean.uncorrected);
    EXPECT_EQ(rest.value, rest.uncorrected);
    means += mean.interval.low <= truth && truth <= mean.interval.high;
    rests += rest.interval.low <= quiet && quiet <= rest.interval.high;
    EXPECT_LT(rest.interval.high - rest.interval.low, 0.2 * quiet);
  }
  EXPECT_GE(means, 10);
  EXPECT_GE(rests, 10);
}

TEST(EmgMeasures, AClippedChannelIsSaidToBe) {
  const auto notes = [](double low, double high) {
    auto channel = burst(3);
    channel.volts = ((channel.volts.array() - 0.02) / kStrong).cwiseMax(low).cwiseMin(high);
    return measure_emg({channel}, kEmg_hz, 0.0, {.refits = 0}).value().notes;
  };
  EXPECT_THAT(notes(-1.5, 1.5), Contains(HasSubstr("EMG1 is clipped: 3")));
  EXPECT_THAT(notes(-1.5, 1.5), Contains(HasSubstr("% of its samples stand at -1.5 or 1.5 V, and its "
                                                   "amplitudes are too small")));
  EXPECT_THAT(notes(-1.25, 9.0), Contains(HasSubstr("stand at -1.25 V, and")));
  EXPECT_THAT(notes(-9.0, 1.25), Contains(HasSubstr("stand at 1.25 V, and")));
  EXPECT_THAT(notes(-9.0, 9.0), Not(Contains(HasSubstr("% of its samples stand at"))));
}

TEST(EmgMeasures, ToAMaximumValuesAreShares) {
  auto channel = burst(4);
  const EmgOptions options{.measures = {"emg_peak", "emg_median_frequency"}, .to_maximum = true, .refits = 0};
  const auto out = measure_emg({channel}, kEmg_hz, 0.0, options).value();
  EXPECT_NEAR(get(out, "emg_peak").value, 1.0, 0.01);
  EXPECT_EQ(get(out, "emg_peak").quantity, data::Quantity::share);
  EXPECT_EQ(get(out, "emg_median_frequency").quantity, data::Quantity::frequency);
  EXPECT_NEAR(out.envelopes[0].maxCoeff(), 1.0, 1e-12);
  channel.most_volts = 2.0 * kStrong;
  const auto half = measure_emg({channel}, kEmg_hz, 0.0, {.measures = {"emg_peak"}, .refits = 0}).value();
  EXPECT_LT(get(half, "emg_peak").value, 0.7);
}

TEST(EmgMeasures, ReasonsForNoIntervalAreThoseOfTheMeasure) {
  const auto plain = measure_emg({burst(3)}, kEmg_hz, 0.0, {.refits = 0}).value();
  EXPECT_THAT(get(plain, "emg_mean").remark, HasSubstr("no interval was asked for"));
  EXPECT_THAT(get(plain, "emg_peak").remark, Not(HasSubstr("chance can only raise it")));

  const auto out =
      measure_emg(
          {burst(3)}, kEmg_hz, 0.0,
          {.stretches = {{.name = "whole", .count = 4000}, {.name = "steady", .first = 1700, .count = 600}},
           .refits = 39})
          .value();
  EXPECT_THAT(get(out, "emg_mean", "whole").remark, Not(HasSubstr("no interval was asked for")));
  EXPECT_THAT(get(out, "emg_mean", "whole").remark, Not(HasSubstr("no burst rises above rest")));
  EXPECT_THAT(get(out, "emg_peak", "whole").remark, HasSubstr("chance can only raise it"));
  EXPECT_THAT(get(out, "emg_peak_time", "steady").remark, HasSubstr("other instants are nearly as good"))
      << "any instant of an even burst may have the peak";
  EXPECT_THAT(get(out, "emg_onset", "whole").remark, Not(HasSubstr("no burst begins or ends")));
  EXPECT_THAT(get(out, "emg_onset", "steady").remark, HasSubstr("no burst begins or ends in the span"));
}

TEST(EmgMeasures, AnInstantThatManyDrawsLackHasNoInterval) {
  const auto onset = [](std::int64_t first) {
    const EmgOptions options{.measures = {"emg_onset"},
                             .stretches = {{.name = "span", .first = first, .count = 2000}},
                             .refits = 39};
    return get(measure_emg({burst(3, 10.0 * kQuiet)}, kEmg_hz, 0.0, options).value(), "emg_onset", "span")
        .remark;
  };
  // Where the span begins with the burst, many draws begin it before.
  int said = 0;
  for (std::int64_t first = 1480; first < 1510; first += 2)
    said += testing::Value(onset(first),
                           HasSubstr("more than a tenth of the simulated channels do not determine it"));
  EXPECT_GT(said, 0);
  EXPECT_THAT(onset(1200), Not(HasSubstr("more than a tenth of the simulated channels do not determine it")));
  EXPECT_THAT(onset(1200), Not(HasSubstr("other instants are nearly as good")));
}

TEST(EmgMeasures, AShortChannelIsNotMeasured) {
  const auto out = measure_emg({burst(3)}, kEmg_hz, 0.0, {.refits = 0}).value();
  EXPECT_THAT(out.notes, Not(Contains(HasSubstr("is shorter than half a second"))));
  EXPECT_THAT(out.notes, Not(Contains(HasSubstr("has missing samples, and is not measured"))));
  auto few = burst(3);
  few.name = "EMG2";
  few.volts = VectorXd(few.volts.head(400));
  const auto both = measure_emg({burst(3), few}, kEmg_hz, 0.0, {.refits = 0}).value();
  EXPECT_THAT(both.notes, Contains("EMG2 is shorter than half a second"));
}

TEST(EmgMeasures, WhatCannotBeMeasuredIsSaid) {
  auto gap = burst(5);
  gap.name = "EMG2";
  gap.volts[7] = kNaN;
  EmgChannel silent{.name = "EMG3", .volts = VectorXd::Zero(4000)};
  const auto out = measure_emg({burst(5), gap, silent}, kEmg_hz, 0.0,
                               {.stretches = {{.name = "rest", .first = 200, .count = 400}}, .refits = 0})
                       .value();
  EXPECT_THAT(out.notes, Contains("EMG2 has missing samples, and is not measured"));
  EXPECT_THAT(out.notes, Contains("EMG3 holds no signal"));
  EXPECT_EQ(get(out, "emg_onset", "rest").remark, "no burst begins or ends in the span");
  EXPECT_THAT(measure_emg({gap}, kEmg_hz, 0.0, {}).error().message, HasSubstr("EMG2 has missing samples"));
  EXPECT_THAT(measure_emg({}, kEmg_hz, 0.0, {}).error().message, HasSubstr("no channel"));
  EXPECT_THAT(measure_emg({}, kEmg_hz, 0.0, {.measures = {"emg_mena"}}).error().message,
              HasSubstr("'emg_mena'"));
  EXPECT_EQ(measure_emg({}, kEmg_hz, 0.0, {.refits = 5}).error().code, Code::usage);
  EXPECT_EQ(measure_emg({}, kEmg_hz, 0.0, {.rest_s = 0.0}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::analysis

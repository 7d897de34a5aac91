// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/around/around.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;

constexpr AroundOptions kWindow{.from_s = -0.2, .to_s = 0.3, .bin_s = 0.1};

/// f(t) sampled at 50 Hz from 0 to `seconds`.
template <class Function>
SampledCurve sampled(double seconds, const Function& f) {
  SampledCurve out{.subject = "f7", .id = "x"};
  for (int i = 0; i <= static_cast<int>(50.0 * seconds); ++i) {
    out.time_s.push_back(0.02 * i);
    out.value.push_back(f(0.02 * i));
  }
  return out;
}

TEST(Around, ALineIsItselfInTheMiddleOfABin) {
  const auto curve = sampled(10.0, [](double t) { return 3.0 + 2.0 * t; });
  const std::vector<double> events{1.003, 4.71, 8.0};
  const auto out = mean_around("unit 1", events, curve, {0.0, 10.0}, kWindow);
  ASSERT_EQ(out.bins.size(), 5U);
  EXPECT_EQ(out.used, 3);
  EXPECT_EQ(out.outside, 0);
  const double mean_event = (1.003 + 4.71 + 8.0) / 3.0;
  for (int k = 0; k < 5; ++k) {
    const auto& bin = out.bins[static_cast<std::size_t>(k)];
    EXPECT_NEAR(bin.mean, 3.0 + 2.0 * (mean_event - 0.15 + 0.1 * k), 1e-12);
    EXPECT_EQ(bin.count, 3);
    EXPECT_EQ(bin.missing, 0);
  }
  // Deviation of the events, and Student's 4.3027 of two degrees of freedom.
  const double sd = 2.0 * std::sqrt((std::pow(1.003 - mean_event, 2) + std::pow(4.71 - mean_event, 2) +
                                     std::pow(8.0 - mean_event, 2)) /
                                    2.0);
  EXPECT_NEAR(out.bins[2].sd, sd, 1e-12);
  EXPECT_NEAR(out.bins[2].high - out.bins[2].mean, 4.302652729911275 * sd / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(out.bins[2].mean - out.bins[2].low, 4.302652729911275 * sd / std::sqrt(3.0), 1e-9);
}

TEST(Around, BinsNarrowerThanAFrameLieOnTheLines) {
  const auto curve = sampled(2.0, [](double t) { return t * t; });
  const auto out =
      mean_around("e", std::vector{1.0}, curve, {0.0, 2.0}, {.from_s = 0.0, .to_s = 0.02, .bin_s = 0.005});
  ASSERT_EQ(out.bins.size(), 4U);
  EXPECT_NEAR(out.bins[1].mean, 1.0 + (1.02 * 1.02 - 1.0) * 0.0075 / 0.02, 1e-12);
  EXPECT_TRUE(std::isnan(out.bins[1].sd)) << "one event has no deviation";
  EXPECT_TRUE(std::isnan(out.bins[1].low));
}

TEST(Around, EventsWhoseWindowLeavesTheRecordingAreCounted) {
  const auto curve = sampled(10.0, [](double t) { return t; });
  const std::vector<double> events{-5.0, 0.1, 0.2, 5.0, 9.7, 9.71, 50.0};
  const auto out = mean_around("e", events, curve, {0.0, 10.0}, kWindow);
  EXPECT_EQ(out.used, 3) << "0.2, 5.0 and 9.7";
  EXPECT_EQ(out.outside, 4);
  const auto none = mean_around("e", std::vector{50.0}, curve, {0.0, 10.0}, kWindow);
  EXPECT_EQ(none.outside, 1);
  EXPECT_TRUE(std::isnan(none.bins[0].mean));
  EXPECT_EQ(none.bins[0].count, 0);
}

TEST(Around, MissingMovementIsCountedBinByBin) {
  auto curve = sampled(10.0, [](double) { return 1.0; });
  curve.value[250] = kNaN;  // at 5.0 s, of lines from 4.98 to 5.02 s
  const auto out = mean_around("e", std::vector{2.0, 5.05}, curve, {0.0, 10.0}, kWindow);
  for (std::size_t k = 0; k < 5; ++k) {
    const bool hidden = k == 1;  // 4.95 to 5.05 s
    EXPECT_EQ(out.bins[k].count, hidden ? 1 : 2) << k;
    EXPECT_EQ(out.bins[k].missing, hidden ? 1 : 0) << k;
    EXPECT_EQ(out.bins[k].mean, 1.0);
  }
}

TEST(Around, SpikesAreCountedInHalfOpenBins) {
  const std::vector<double> spikes{0.75, 1.0, 1.05, 1.125, 1.25, 3.0};
  const auto out = rate_around("Movement Start", std::vector{1.0, 3.0}, "4", spikes, {0.0, 10.0},
                               {.from_s = -0.25, .to_s = 0.25, .bin_s = 0.125});
  EXPECT_EQ(out.id, "rate");
  EXPECT_EQ(out.quantity, data::Quantity::frequency);
  ASSERT_EQ(out.bins.size(), 4U);
  EXPECT_EQ(out.bins[0].mean, 4.0) << "0.75 of the first event, none of the second";
  EXPECT_EQ(out.bins[1].mean, 0.0);
  EXPECT_EQ(out.bins[2].mean, 12.0) << "1.0 and 1.05, 3.0";
  EXPECT_EQ(out.bins[3].mean, 4.0) << "1.125, not 1.25";
}

TEST(Around, ADeviationOfTheClockWidensWhereTheMeanIsSteep) {
  const auto curve = sampled(10.0, [](double t) { return std::sin(2.0 * std::numbers::pi * t); });
  std::vector<double> events;
  Random random(3, 1);
  for (int i = 1; i < 9; ++i) events.push_back(i + 0.001 * random.gaussian());
  auto with = kWindow;
  with.clock_sd_s = 0.05;
  const auto sure = mean_around("e", events, curve, {0.0, 10.0}, kWindow);
  const auto unsure = mean_around("e", events, curve, {0.0, 10.0}, with);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(sure.bins[k].mean, unsure.bins[k].mean);
  const double slope = (sure.bins[3].mean - sure.bins[1].mean) / 0.2;
  const double half = sure.bins[2].high - sure.bins[2].mean;
  EXPECT_NEAR(unsure.bins[2].high - unsure.bins[2].mean, std::hypot(half, 1.959963984540054 * 0.05 * slope),
              1e-9);
}

TEST(Around, IntervalsHoldTheRateOfAPoissonProcess) {
  Random random(11, 2);
  int held = 0, all = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> spikes, events;
    for (double t = -std::log1p(-random.uniform()) / 20.0; t < 60.0;
         t += -std::log1p(-random.uniform()) / 20.0)
      spikes.push_back(t);
    for (int i = 0; i < 40; ++i) events.push_back(random.uniform(0.5, 59.0));
    std::ranges::sort(events);
    const auto out =
        rate_around("e", events, "1", spikes, {0.0, 60.0}, {.from_s = 0.0, .to_s = 0.2, .bin_s = 0.2});
    ++all;
    held += out.bins[0].low <= 20.0 && 20.0 <= out.bins[0].high ? 1 : 0;
  }
  EXPECT_GT(held, all * 88 / 100) << "windows overlap a little";
  EXPECT_LT(held, all) << "intervals are not endless";
}

TEST(Around, AWindowIsMadeOfWholeBins) {
  const auto fault = [](const AroundOptions& options) {
    const auto status = options.check();
    return status ? "" : status.error().message;
  };
  EXPECT_EQ(fault({}), "");
  EXPECT_EQ(AroundOptions{}.bins(), 75);
  EXPECT_THAT(fault({.from_s = 0.0, .to_s = 0.5, .bin_s = 0.2}), HasSubstr("is 2.5 bins of 0.2 s"));
  EXPECT_THAT(fault({.from_s = 1.0, .to_s = 0.5}), HasSubstr("need FROM,TO with FROM below TO"));
  EXPECT_THAT(fault({.bin_s = 0.0}), HasSubstr("need a length above 0"));
  EXPECT_THAT(fault({.from_s = 0.0, .to_s = 1000.0, .bin_s = 0.001}), HasSubstr("100000 at most"));
  EXPECT_THAT(fault({.level = 0.4}), HasSubstr("need a share above 0.5"));
  EXPECT_THAT(fault({.clock_sd_s = -1.0}), HasSubstr("need 0 or more"));
}

}  // namespace
}  // namespace kinemark::analysis

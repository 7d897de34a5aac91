// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kSigma = 0.001;

data::Trajectories noise_only(int frames) {
  auto t = data::Trajectories::all_missing({"A"}, {100.0, 0.0, frames});
  Random random(11, 4);
  for (int f = 0; f < frames; ++f) {
    for (int axis = 0; axis < 3; ++axis) t.x(f, 0)[axis] = kSigma * random.gaussian();
    t.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  return t;
}

SmoothOptions of(FilterMethod method, double cutoff_hz = 0.0) {
  SmoothOptions options;
  options.method = method;
  options.cutoff_hz = cutoff_hz;
  return options;
}

double rms(const Array<double>& values, std::size_t frames) {
  double sum = 0.0;
  for (std::size_t i = 150; i < 3 * frames - 150; ++i) sum += values[i] * values[i];
  return std::sqrt(sum / static_cast<double>(3 * frames - 300));
}

TEST(Butterworth, BarsAreTheNoiseThatPasses) {
  const auto in = noise_only(6000);
  for (const FilterMethod method : {FilterMethod::butterworth, FilterMethod::classic, FilterMethod::none}) {
    SmoothOptions options = of(method, method == FilterMethod::none ? 0.0 : 8.0);
    options.noise_sd_m = kSigma;
    const auto out = smooth(in, options).value();
    EXPECT_NEAR(rms(out.trajectories.x_in_world, 6000) / std::sqrt(out.trajectories.covariance[6 * 3000]),
                1.0, 0.05);
    EXPECT_NEAR(rms(out.derivatives.velocity, 6000) / out.derivatives.velocity_sd[9000], 1.0, 0.05);
    EXPECT_NEAR(rms(out.derivatives.acceleration, 6000) / out.derivatives.acceleration_sd[9000], 1.0, 0.05);
    EXPECT_NEAR(rms(out.derivatives.jerk, 6000) / out.derivatives.jerk_sd[9000], 1.0, 0.05);
  }
}

TEST(Butterworth, NoiseIsFoundFromWhatItTookAway) {
  const auto out = smooth(noise_only(3000), of(FilterMethod::butterworth, 8.0)).value();
  EXPECT_NEAR(out.markers[0].used.noise_sd_m, kSigma, 0.05 * kSigma);
  EXPECT_EQ(out.markers[0].noise_from, "data");
}

TEST(Butterworth, ClassicIsTwelveHertzEachWayAndLessTogether) {
  const auto in = noise_only(500);
  const auto out = smooth(in, of(FilterMethod::classic)).value();
  EXPECT_NEAR(out.derivatives.filters[0].cutoff_hz, 100.0 * math::two_pass_half_power(2, 0.12), 1e-9);
  EXPECT_LT(out.derivatives.filters[0].cutoff_hz, 10.0);
  EXPECT_THAT(out.markers[0].description, HasSubstr("1986"));
  std::vector<double> x;
  for (int f = 0; f < 500; ++f) x.push_back(in.x(f, 0).x());
  math::filter_both_ways(math::butterworth_lowpass(2, 0.12), math::usual_padding(2), x);
  for (int f = 0; f < 500; ++f) EXPECT_EQ(out.trajectories.x(f, 0).x(), x[static_cast<std::size_t>(f)]);
  EXPECT_NEAR(out.derivatives.velocity[3 * 100], (x[101] - x[99]) * 50.0, 1e-12);
}

TEST(Butterworth, ClassicFitsSlowRecordings) {
  auto in = noise_only(200);
  in.time.rate_hz = 20.0;
  EXPECT_TRUE(smooth(in, of(FilterMethod::classic)));
}

TEST(Butterworth, StretchesAreFilteredApart) {
  auto in = noise_only(300);
  for (int f = 100; f < 110; ++f) in.set_missing(f, 0);
  auto changed = in;
  for (int f = 110; f < 300; ++f) changed.x(f, 0).array() += 7.0;
  const auto a = smooth(in, of(FilterMethod::butterworth, 6.0)).value();
  const auto b = smooth(changed, of(FilterMethod::butterworth, 6.0)).value();
  for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(a.derivatives.velocity[i], b.derivatives.velocity[i]) << i;
}

TEST(Butterworth, SaysWhatWasAskedAndWhatWasFound) {
  const auto said = [](const SmoothOptions& options, int frames = 300) {
    return smooth(noise_only(frames), options)->markers[0].description;
  };
  const auto asked = said(of(FilterMethod::butterworth, 7.5)), found = said(of(FilterMethod::butterworth)),
             classic = said(of(FilterMethod::classic)), none = said(of(FilterMethod::none));
  EXPECT_THAT(asked, HasSubstr("Order 2 both ways, 7.5 Hz as asked."));
  EXPECT_THAT(found, Not(HasSubstr("Hz as asked.")));
  EXPECT_THAT(found, HasSubstr("Order 2 both ways, "));
  EXPECT_THAT(none, HasSubstr("Not filtered; two-point differences."));
  EXPECT_THAT(asked, Not(HasSubstr("Not filtered; two-point")));
  EXPECT_THAT(none, Not(HasSubstr("Order 2 both ways, ")));
  EXPECT_THAT(classic, HasSubstr("Hz together, two-point differences."));
  EXPECT_THAT(found, Not(HasSubstr("Hz together, two-point differences.")));
  EXPECT_THAT(said(of(FilterMethod::butterworth), 8),
              HasSubstr(": no span of 12 samples to choose a cut-off by."));
  EXPECT_THAT(found, Not(HasSubstr("samples to choose a cut-off by.")));
}

TEST(Butterworth, RulesAreNamed) {
  SmoothOptions options = of(FilterMethod::butterworth);
  EXPECT_THAT(smooth(noise_only(300), options)->markers[0].description, HasSubstr("Winter"));
  options.cutoff_rule = CutoffRule::challis;
  EXPECT_THAT(smooth(noise_only(300), options)->markers[0].description, HasSubstr("Challis"));
  EXPECT_THAT(smooth(noise_only(8), options)->markers[0].description, HasSubstr("no span of 12 samples"));
}

}  // namespace
}  // namespace kinemark::trajectory

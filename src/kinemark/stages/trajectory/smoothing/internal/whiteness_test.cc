// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/whiteness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kRateHz = 100.0;

/// A filter that takes everything: the residual is the noise itself.
const std::vector<double> kTakesAll{0.0, 0.0, 0.0};

/// Noise whose axes have SD 1, 2 and 3; each sample is `keeps` times the one before plus news.
std::vector<double> noise(std::int64_t frames, std::uint64_t seed, double keeps) {
  Random random(seed, 1);
  std::vector<double> x(at(3 * frames));
  for (std::int64_t f = 0; f < frames; ++f)
    for (int axis = 0; axis < 3; ++axis)
      x[at(3 * f + axis)] = (f > 0 ? keeps * x[at(3 * f - 3 + axis)] : 0.0) + (axis + 1) * random.gaussian();
  return x;
}

TEST(Whiteness, TheChanceOfWhiteNoiseIsThatStated) {
  int below_1 = 0, below_20 = 0, below_50 = 0;
  constexpr int kTrials = 400;
  for (int seed = 0; seed < kTrials; ++seed) {
    const std::int64_t frames = seed % 2 == 0 ? 90 : 2000;
    const Whiteness found = test_whiteness(noise(frames, 100 + static_cast<std::uint64_t>(seed), 0.0),
                                           {{0, frames}}, kTakesAll, 10.0, kRateHz);
    ASSERT_FALSE(std::isnan(found.p));
    below_1 += found.p < 0.01;
    below_20 += found.p < 0.2;
    below_50 += found.p < 0.5;
  }
  // Within three standard deviations of the binomial distribution; on few bins the test is a little
  // conservative.
  EXPECT_LE(below_1, 10);
  EXPECT_NEAR(below_20, 0.2 * kTrials, 24.0 + 0.05 * kTrials);
  EXPECT_NEAR(below_50, 0.5 * kTrials, 30.0 + 0.08 * kTrials);
}

TEST(Whiteness, ColouredNoiseIsRecognisedAndItsSideNamed) {
  const std::vector<Stretch> all{{0, 2000}};
  const Whiteness slow = test_whiteness(noise(2000, 7, 0.4), all, kTakesAll, 5.0, kRateHz);
  EXPECT_LT(slow.p, 1e-6);
  EXPECT_GT(slow.departure, 0.1);
  const Whiteness fast = test_whiteness(noise(2000, 7, -0.85), all, kTakesAll, 5.0, kRateHz);
  EXPECT_LT(fast.p, 1e-6);
  EXPECT_LT(fast.departure, -0.3);
}

TEST(Whiteness, IsNotJudgedWhereItCannotBe) {
  const std::vector<double> x = noise(300, 3, 0.0), still(900, 0.0);
  EXPECT_TRUE(std::isnan(test_whiteness(x, {{0, 60}}, kTakesAll, 10.0, kRateHz).p)) << "too short";
  EXPECT_TRUE(std::isnan(test_whiteness(x, {}, kTakesAll, 10.0, kRateHz).p)) << "no sample";
  EXPECT_TRUE(std::isnan(test_whiteness(still, {{0, 300}}, kTakesAll, 10.0, kRateHz).p)) << "no residual";
  EXPECT_TRUE(std::isnan(test_whiteness(x, {{0, 300}}, kTakesAll, kNaN, kRateHz).p)) << "no filter";
  const std::vector<double> takes_next_to_nothing{0.0, 0.9, 0.0};
  EXPECT_TRUE(std::isnan(test_whiteness(x, {{0, 300}}, takes_next_to_nothing, 10.0, kRateHz).p));
}

/// White, or coloured, noise of 1 mm on a slow circle, smoothed by a filter.
data::MarkerAccount account_of(const SmoothOptions& options, std::uint64_t seed, double keeps,
                               std::int64_t frames = 1000) {
  auto in = data::Trajectories::all_missing({"M"}, {.rate_hz = kRateHz, .frames = frames});
  const std::vector<double> n = noise(frames, seed, keeps);
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / kRateHz;
    for (int axis = 0; axis < 3; ++axis)
      in.x_in_world[at(3 * f + axis)] =
          0.1 * std::sin(2.0 * M_PI * 0.7 * t + axis) + 1e-3 * n[at(3 * f + axis)];
    in.state[at(f)] = data::SampleState::measured;
  }
  return smooth(in, options).value().markers.front();
}

class WhitenessOfFilters : public testing::TestWithParam<FilterMethod> {};

TEST_P(WhitenessOfFilters, WhatTheFilterKeepsIsNotHeldAgainstTheNoise) {
  // A wide filter makes a residual with strong autocorrelation of white noise.
  for (const double cutoff_hz : {4.0, 12.0, 25.0}) {
    SmoothOptions options;
    options.method = GetParam();
    options.cutoff_hz = cutoff_hz;
    options.order = GetParam() == FilterMethod::classic ? 0 : 4;
    int coloured = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const data::MarkerAccount account = account_of(options, 50 + seed, 0.0);
      EXPECT_TRUE(account.judged());
      coloured += account.coloured();
      if (seed > 0) continue;
      ASSERT_EQ(account.white_autocorrelation.size(), account.autocorrelation.size());
      for (std::size_t lag = 0; lag < account.autocorrelation.size(); ++lag)
        EXPECT_NEAR(account.autocorrelation[lag], account.white_autocorrelation[lag], 0.09) << lag;
    }
    EXPECT_LE(coloured, 1) << cutoff_hz;
    // Above 25 Hz noise that is only a little coloured is nearly flat.
    EXPECT_TRUE(account_of(options, 90, cutoff_hz > 20.0 ? -0.85 : 0.5).coloured()) << cutoff_hz;
  }
}

INSTANTIATE_TEST_SUITE_P(All, WhitenessOfFilters,
                         testing::Values(FilterMethod::kalman, FilterMethod::gcv, FilterMethod::butterworth,
                                         FilterMethod::savgol, FilterMethod::classic),
                         [](const auto& method) { return std::string(to_string(method.param)); });

TEST(Whiteness, LostMovementIsNotCalledWhite) {
  SmoothOptions options;
  options.order = 4;
  options.cutoff_hz = 0.3;  // below the movement
  EXPECT_TRUE(account_of(options, 1, 0.0).coloured());
  EXPECT_THAT(account_of(options, 1, 0.0).description, testing::HasSubstr("not white"));
}

TEST(Whiteness, NothingIsSaidOfASpectrumThatIsHardlyThere) {
  SmoothOptions options;
  options.order = 2;
  options.cutoff_hz = 40.0;
  const data::MarkerAccount account = account_of(options, 1, -0.85);
  EXPECT_FALSE(account.judged());
  EXPECT_FALSE(account.coloured());
  EXPECT_THAT(account.description, testing::HasSubstr("too little of its band"));
  EXPECT_THAT(account.description, testing::Not(testing::HasSubstr("consistent with white")));
}

TEST(Whiteness, SaysWhichSideTheColourIsOnAndWhatThatDoes) {
  SmoothOptions options;
  options.order = 4;
  options.cutoff_hz = 5.0;
  const std::string white = account_of(options, 1, 0.0).description,
                    slow = account_of(options, 1, 0.8).description;
  EXPECT_THAT(white, testing::HasSubstr(" The residual ("));
  EXPECT_THAT(white, testing::HasSubstr(" is consistent with white noise (cumulative periodogram, p = "));
  EXPECT_THAT(white,
              testing::Not(testing::HasSubstr("because the noise is coloured, the recording was filtered")));
  EXPECT_THAT(white, testing::Not(testing::HasSubstr("to tell whether it is white.")));
  EXPECT_THAT(slow, testing::HasSubstr(
                        "% of the noise power lies too low in frequency, because the noise is coloured, "
                        "the recording was filtered before, or movement was lost"));
  EXPECT_THAT(slow, testing::HasSubstr("are then too small."));
  EXPECT_THAT(slow, testing::Not(testing::HasSubstr("is consistent with white noise")));
}

TEST(Whiteness, NoFilterLeavesNothingToJudge) {
  SmoothOptions options;
  options.method = FilterMethod::none;
  const data::MarkerAccount account = account_of(options, 1, 0.0);
  EXPECT_FALSE(account.judged());
  EXPECT_THAT(account.description, testing::Not(testing::HasSubstr("white")));
  EXPECT_THAT(account.description, testing::Not(testing::HasSubstr(" The residual (")));
}

/// A movement whose third derivative is white, which order 3 describes best, in white noise.
data::Trajectories rough_movement(std::uint64_t seed) {
  constexpr std::int64_t kFrames = 300;
  auto in = data::Trajectories::all_missing({"M"}, {.rate_hz = kRateHz, .frames = kFrames});
  Random random(seed, 2);
  const Eigen::Vector3d nothing = Eigen::Vector3d::Zero();
  Eigen::Vector3d x = nothing, velocity = nothing, acceleration = nothing;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      acceleration(axis) += 2.0 * random.gaussian();
      in.x(f, 0)(axis) = x(axis) + 1e-3 * random.gaussian();
    }
    velocity += acceleration / kRateHz;
    x += velocity / kRateHz;
    in.state[at(f)] = data::SampleState::measured;
  }
  return in;
}

TEST(ChoiceOfTheFilter, LeastIsSaidOfTheLeastAlone) {
  int least = 0, other = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const data::MarkerAccount account = smooth(rough_movement(200 + seed)).value().markers.front();
    const auto best = std::ranges::min_element(account.candidates, {}, &data::FilterCandidate::criterion);
    const bool taken = best->order == account.used.order;
    (taken ? least : other) += 1;
    EXPECT_EQ(
        account.description.contains("the least expected error (SURE) of all orders and cut-offs tried"),
        taken)
        << account.description;
    EXPECT_EQ(account.description.contains("order " + std::to_string(best->order) + " has"), !taken)
        << account.description;
    if (taken) {
      EXPECT_FALSE(account.description.contains(", which is too little to give up jerk for"));
    } else {
      EXPECT_TRUE(account.description.contains(", which is too little to give up jerk for"));
    }
  }
  EXPECT_GT(least, 0);
  EXPECT_GT(other, 0) << "no case in which it must not be said";
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing

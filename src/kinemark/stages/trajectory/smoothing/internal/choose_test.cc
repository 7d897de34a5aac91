// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/choose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kSigma = 0.002;

struct Data {
  std::vector<double> y, truth;
  std::vector<std::uint8_t> seen;
  Series series;
  explicit Data(int frames, double frequency_hz = 1.3) {
    Random random(6, 1);
    for (int i = 0; i < frames; ++i) {
      truth.push_back(0.2 * std::sin(2.0 * M_PI * frequency_hz * i / 100.0));
      y.push_back(truth.back() + kSigma * random.gaussian());
    }
    seen.assign(static_cast<std::size_t>(frames), 1);
    series = {frames, 1, y.data(), seen.data(), nullptr, nullptr, 0.01};
  }
};

double true_error(const Data& data, int order, double cutoff_hz) {
  std::vector<double> state(data.y.size() * 4), variance(data.y.size() * 4);
  smooth_series(data.series, order, cutoff_hz, {state.data(), variance.data()});
  double sum = 0.0;
  for (std::size_t i = 0; i < data.y.size(); ++i) sum += std::pow(state[4 * i] - data.truth[i], 2);
  return std::sqrt(sum / static_cast<double>(data.y.size()));
}

TEST(Choose, FindsTheNoiseAndNearlyTheBestFilter) {
  const Data data(1500);
  for (const auto criterion : {Criterion::sure, Criterion::gcv}) {
    const Choice choice = choose(std::vector<Series>{data.series}, {criterion, 0, 0.0, 0.0, 100.0});
    EXPECT_TRUE(choice.enough);
    EXPECT_NEAR(choice.noise_sd_m, kSigma, 0.06 * kSigma);
    EXPECT_EQ(choice.candidates.size(), criterion == Criterion::sure ? 4u : 3u);
    double best = std::numeric_limits<double>::infinity();
    for (int order = 2; order <= 5; ++order)
      for (double cutoff = 1.0; cutoff < 30.0; cutoff *= 1.1)
        best = std::min(best, true_error(data, order, cutoff));
    EXPECT_LT(true_error(data, choice.order, choice.cutoff_hz), 1.1 * best);
  }
}

TEST(Choose, KeepsWhatIsGiven) {
  const Data data(300);
  const Choice choice = choose(std::vector<Series>{data.series}, {Criterion::sure, 3, 7.0, 0.001, 100.0});
  EXPECT_EQ(choice.order, 3);
  EXPECT_NEAR(choice.cutoff_hz, 7.0, 1e-9);
  EXPECT_EQ(choice.noise_sd_m, 0.001);
  ASSERT_EQ(choice.candidates.size(), 1u);
  const Scores scores = smooth_series(data.series, 3, 7.0, {});
  EXPECT_NEAR(choice.candidates[0].criterion / ((scores.rss + 2e-6 * scores.trace) / 300.0), 1.0, 1e-9);
}

TEST(Choose, CriteriaFollowTheirFormulas) {
  const Scores scores{8.0, 5.0, 20};
  EXPECT_DOUBLE_EQ(criterion_value(Criterion::sure, scores, 0.5), (8.0 + 2.0 * 0.25 * 5.0) / 20.0);
  EXPECT_DOUBLE_EQ(criterion_value(Criterion::gcv, scores, 0.5), 8.0 / 20.0 / (0.75 * 0.75));
}

TEST(Choose, TooFewSamplesTakeTheDefaults) {
  const Data data(11);
  const Choice choice = choose(std::vector<Series>{data.series}, {Criterion::sure, 0, 0.0, 0.0, 100.0});
  EXPECT_FALSE(choice.enough);
  EXPECT_EQ(choice.order, 4);
  EXPECT_EQ(choice.cutoff_hz, 6.0);
  EXPECT_TRUE(std::isnan(choice.noise_sd_m));
}

TEST(Choose, WindowsStandForLongRecordings) {
  Data data(40000);
  EXPECT_EQ(windows(Data(16384).series).size(), 1u);
  for (std::size_t i = 5000; i < 30000; ++i) data.seen[i] = 0;
  const auto parts = windows(data.series);
  EXPECT_GE(parts.size(), 6u);
  std::int64_t before = -1;
  for (const Series& part : parts) {
    const std::int64_t begin = part.y - data.y.data();
    EXPECT_GT(begin, before);  // they do not overlap
    EXPECT_NE(part.seen[0], 0);
    EXPECT_LE(part.frames, 2048);
    before = begin + part.frames - 1;
  }
  EXPECT_LT(before, 40000);
}

TEST(Refine, LowersTheCutoffOfAMovementThatEndsBelowIt) {
  const Data data(3000);
  const std::vector<Series> parts{data.series};
  const double refined = refine_cutoff(parts, 5, 6.0, kSigma);
  EXPECT_LT(refined, 5.6);
  EXPECT_GE(refined, 6.0 * std::sqrt(0.7) - 1e-9);
}

TEST(Refine, DoesNotCutWhereTheMovementIs) {
  const Data data(3000, 5.0);
  const std::vector<Series> parts{data.series};
  EXPECT_GT(refine_cutoff(parts, 5, 6.0, 0.1 * kSigma), 6.0);
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing

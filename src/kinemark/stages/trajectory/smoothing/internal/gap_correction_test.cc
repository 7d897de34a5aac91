// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/gap_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kInterval_s = 0.01, kNoise_m = 1e-4;
constexpr std::int64_t kLongest = 100;

/// A coordinate along three axes in noise, with a gap in every 150 frames.
struct Gappy {
  std::vector<double> truth, y;
  std::vector<std::uint8_t> seen;

  Gappy(const std::function<double(double, int)>& x, std::int64_t gap, std::uint64_t seed,
        std::int64_t frames = 600)
      : seen(static_cast<std::size_t>(frames), 1) {
    Random random(seed, 1);
    for (std::int64_t k = 0; k < frames; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        truth.push_back(x(kInterval_s * static_cast<double>(k), axis));
        y.push_back(truth.back() + kNoise_m * random.gaussian());
      }
    for (std::int64_t at = 70; at + gap < frames; at += 150) std::fill_n(seen.begin() + at, gap, 0);
  }
  [[nodiscard]] Series series() const {
    return {
        .frames = std::ssize(seen), .axes = 3, .y = y.data(), .seen = seen.data(), .interval_s = kInterval_s};
  }
  [[nodiscard]] std::vector<double> smoothed(int order, double cutoff_hz) const {
    std::vector<double> state(4 * y.size()), variance(4 * seen.size());
    smooth_series(series(), order, cutoff_hz, {state.data(), variance.data()});
    return state;
  }
  /// RMS error of position where there is no sample, m.
  [[nodiscard]] double error_in_gaps(const std::vector<double>& state) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k)
      for (std::size_t i = 3 * k; i < 3 * k + 3 && seen[k] == 0; ++i) {
        sum += std::pow(state[4 * i] - truth[i], 2);
        count += 1.0;
      }
    return std::sqrt(sum / count);
  }
};

/// A tremor of 4 mm and 6 Hz.
double tremor(double t, int axis) { return 4e-3 * std::sin(2.0 * M_PI * 6.0 * t + axis); }
/// A slow movement of 100 mm.
double slow(double t, int axis) { return 0.1 * std::sin(2.0 * M_PI * 0.4 * t + axis); }

GapCorrection correct(const Gappy& record, std::vector<double>& state, int order = 5, double cutoff_hz = 9.0,
                      std::int64_t longest = kLongest) {
  const Series series = record.series();
  return correct_gaps({&series, 1}, series, order, cutoff_hz, longest, state);
}

TEST(GapCorrection, AGapAsLongAsAPeriodIsFilledByWhatRepeats) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Gappy record(tremor, 16, seed);
    std::vector<double> state = record.smoothed(5, 9.0);
    const double before = record.error_in_gaps(state);
    const GapCorrection done = correct(record, state);
    EXPECT_EQ(done.gaps, 4) << seed;
    EXPECT_GE(done.hidden, 16);
    EXPECT_LT(record.error_in_gaps(state), 0.3 * before) << seed;
    EXPECT_LT(done.error_left, 0.4);
  }
}

TEST(GapCorrection, GapsWithFewSamplesBetweenAreOne) {
  Gappy record(tremor, 16, 3);
  for (const std::size_t at : {77, 227, 377, 527}) record.seen[at] = 1;
  std::vector<double> state = record.smoothed(5, 9.0);
  const double before = record.error_in_gaps(state);
  EXPECT_EQ(correct(record, state).gaps, 4);
  EXPECT_LT(record.error_in_gaps(state), 0.5 * before);
}

TEST(GapCorrection, DerivativesStayThoseOfThePositions) {
  const Gappy record(tremor, 16, 2);
  std::vector<double> state = record.smoothed(5, 9.0);
  const std::vector<double> before = state;
  ASSERT_GT(correct(record, state).gaps, 0);
  double largest = 0.0, off = 0.0;
  for (std::size_t k = 67; k < 89; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto change = [&](std::size_t frame, std::size_t d) {
        const std::size_t i = 4 * (3 * frame + axis) + d;
        return state[i] - before[i];
      };
      largest = std::max(largest, std::abs(change(k, 1)));
      off =
          std::max(off, std::abs((change(k + 1, 0) - change(k - 1, 0)) / (2.0 * kInterval_s) - change(k, 1)));
    }
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(off, 0.15 * largest);
}

TEST(GapCorrection, NothingFarFromGapsChanges) {
  const Gappy record(tremor, 16, 4);
  std::vector<double> state = record.smoothed(5, 9.0);
  const std::vector<double> before = state;
  const GapCorrection done = correct(record, state);
  ASSERT_GT(done.gaps, 0);
  ASSERT_EQ(done.left.size(), 4 * record.seen.size());
  for (std::size_t k = 110; k < 200; ++k) {
    for (std::size_t i = 12 * k; i < 12 * k + 12; ++i) EXPECT_EQ(state[i], before[i]) << k;
    EXPECT_EQ(done.left[4 * k], 1.0);
  }
  EXPECT_LT(done.left[4 * 78], 0.2);
}

TEST(GapCorrection, NoiseTeachesNothing) {
  // The smoothest way is right for these; what is changed must not be worse than chance.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Gappy record(slow, 8, seed);
    std::vector<double> state = record.smoothed(4, 2.0);
    const double before = record.error_in_gaps(state);
    (void)correct(record, state, 4, 2.0);
    EXPECT_LT(record.error_in_gaps(state), 1.1 * before) << seed;
  }
}

TEST(GapCorrection, WithoutGapsToFillNothingIsChanged) {
  const auto unchanged = [](const Gappy& record, std::int64_t longest) {
    std::vector<double> state = record.smoothed(5, 9.0);
    const std::vector<double> before = state;
    const GapCorrection done = correct(record, state, 5, 9.0, longest);
    EXPECT_EQ(done.gaps, 0);
    EXPECT_TRUE(done.left.empty());
    for (std::size_t i = 0; i < state.size(); ++i)
      EXPECT_TRUE(state[i] == before[i] || (std::isnan(state[i]) && std::isnan(before[i]))) << i;
  };
  unchanged(Gappy(tremor, 0, 1), kLongest);
  unchanged(Gappy(tremor, 2, 1), kLongest);
  unchanged(Gappy(tremor, 16, 1), 15);
  unchanged(Gappy(tremor, 16, 1, 100), kLongest);  // too short to learn from
  unchanged(Gappy(tremor, 70, 1), kLongest);       // nothing reaches across so long a gap
}

TEST(GapCorrection, TurnsWithTheLaboratory) {
  const Gappy record(tremor, 16, 6);
  Gappy turned = record;
  for (std::size_t k = 0; k < record.seen.size(); ++k) {  // by 30 degrees about the third axis
    const double c = std::cos(M_PI / 6.0), s = std::sin(M_PI / 6.0);
    turned.y[3 * k] = c * record.y[3 * k] - s * record.y[3 * k + 1];
    turned.y[3 * k + 1] = s * record.y[3 * k] + c * record.y[3 * k + 1];
  }
  std::vector<double> a = record.smoothed(5, 9.0), b = turned.smoothed(5, 9.0);
  (void)correct(record, a);
  (void)correct(turned, b);
  const double c = std::cos(M_PI / 6.0), s = std::sin(M_PI / 6.0);
  for (std::size_t k = 70; k < 86; ++k) EXPECT_NEAR(b[12 * k], c * a[12 * k] - s * a[12 * k + 4], 1e-9) << k;
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::int64_t kSamples = 600;
constexpr TimeBase kTime{.rate_hz = 100.0, .frames = kSamples};

// Five points that swing at one cycle a second and rest between, as feet do, with noise of 0.4 mm, correlated
// from sample to sample.
class GaitNoiseTest : public ::testing::Test {
 protected:
  GaitNoiseTest() { draw(0.0); }
  void draw(double correlation) {
    Random random(7, 3);
    const double fresh = std::sqrt(1.0 - correlation * correlation);
    series_.assign(5, SeriesMatrix::Zero(kSamples, 3));
    for (auto& x : series_)
      for (int axis = 0; axis < 3; ++axis) {
        double e = random.gaussian();
        for (std::int64_t f = 0; f < kSamples; ++f, e = correlation * e + fresh * random.gaussian())
          x(f, axis) = 0.1 * std::exp(2.0 * std::sin(0.0628 * static_cast<double>(f) + axis)) + 4e-4 * e;
      }
    points_.clear();
    for (const auto& x : series_) points_.push_back({.name = "P", .x = &x, .seen = &seen_});
  }
  // Mean square, and mean product of neighbours over it, of what is put on a path.
  [[nodiscard]] std::pair<double, double> drawn(const GaitNoise& noise) const {
    double squares = 0.0, products = 0.0;
    for (std::int64_t k = 0; k < 99; ++k) {
      const auto x = with_noise(SeriesMatrix::Zero(kSamples, 3), noise.of_points[1], 5, 6, k);
      squares += x.squaredNorm() / (3.0 * kSamples * 99.0);
      products += x.topRows(kSamples - 1).cwiseProduct(x.bottomRows(kSamples - 1)).sum() /
                  (3.0 * (kSamples - 1) * 99.0);
    }
    return {std::sqrt(squares), products / squares};
  }

  std::vector<bool> seen_ = std::vector<bool>(kSamples, true);
  std::vector<SeriesMatrix> series_;
  std::vector<GaitPointSamples> points_;
};

TEST_F(GaitNoiseTest, OfWhiteNoiseIsWhiteAndAsLarge) {
  const auto noise = find_gait_noise(points_, kTime, 0.0, 1);
  ASSERT_EQ(noise.of_points.size(), 5U);
  const auto [sd, neighbours] = drawn(noise);
  EXPECT_NEAR(sd, 4e-4, 4e-5);
  EXPECT_NEAR(neighbours, 0.0, 0.1);
  EXPECT_THAT(noise.sentences(), Contains(HasSubstr("mm a sample of feet and pelvis: 5 of 5 white")));
  EXPECT_THAT(noise.sentences(), Not(Contains(HasSubstr(", its size as stated"))));
}

TEST_F(GaitNoiseTest, OfNoiseThatRemembersRemembers) {
  draw(0.9);
  const auto noise = find_gait_noise(points_, kTime, 0.0, 1);
  const auto [sd, neighbours] = drawn(noise);
  EXPECT_GT(sd, 2.5e-4);
  EXPECT_LT(sd, 8e-4);
  EXPECT_GT(neighbours, 0.75);
  EXPECT_THAT(noise.sentences(), Contains(HasSubstr("correlated")));
}

TEST_F(GaitNoiseTest, AStatedSizeCounts) {
  const auto noise = find_gait_noise(points_, kTime, 1e-3, 1);
  EXPECT_NEAR(drawn(noise).first, 1e-3, 1e-4);
  EXPECT_THAT(noise.sentences(), Contains(HasSubstr(", its size as stated")));
}

TEST_F(GaitNoiseTest, WithoutNoiseNothingIsPutOnAndNothingIsSaid) {
  for (auto& x : series_) x.setConstant(0.25);
  const auto noise = find_gait_noise(points_, kTime, 0.0, 1);
  EXPECT_EQ(with_noise(SeriesMatrix::Zero(kSamples, 3), noise.of_points[0], 5, 6, 0).norm(), 0.0);
  EXPECT_THAT(noise.sentences(), IsEmpty());
}

}  // namespace
}  // namespace kinemark::analysis

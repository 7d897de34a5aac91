// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/refits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/shape.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

Recording recording_of(const SeriesMatrix& truth, double noise_m) {
  Recording out{.x = truth,
                .seen = std::vector<bool>(static_cast<std::size_t>(truth.rows()), true),
                .rate_hz = 100.0,
                .noise_sd_m = noise_m,
                .choice = {.order = 4, .half_power = 0.06}};
  for (std::size_t i = 70; i < 76; ++i) out.seen[i] = false;
  out.x = with_noise(truth, out.seen, noise_m, 5, 0, 0);
  return out;
}

TEST(WithNoise, HasTheDeviationAskedForOnSeenSamplesAlone) {
  const SeriesMatrix still = SeriesMatrix::Zero(3000, 3);
  std::vector<bool> seen(3000, true);
  for (std::size_t i = 100; i < 200; ++i) seen[i] = false;
  const auto noisy = with_noise(still, seen, 0.002, 1, 2, 3);
  EXPECT_EQ(noisy.middleRows(100, 100).norm(), 0.0);
  EXPECT_NEAR(noisy.norm() / std::sqrt(3.0 * 2900.0), 0.002, 5e-5);
  EXPECT_EQ(noisy, with_noise(still, seen, 0.002, 1, 2, 3));
  EXPECT_NE(noisy, with_noise(still, seen, 0.002, 1, 2, 4));
  EXPECT_NE(noisy, with_noise(still, seen, 0.002, 1, 3, 3));
}

TEST(WithNoise, DrawsOfOtherSamplesDoNotDependOnGaps) {
  const SeriesMatrix still = SeriesMatrix::Zero(20, 3);
  std::vector<bool> all(20, true), gap = all;
  gap[4] = false;
  const auto a = with_noise(still, all, 1.0, 1, 1, 0), b = with_noise(still, gap, 1.0, 1, 1, 0);
  EXPECT_EQ(a.bottomRows(15), b.bottomRows(15));
}

TEST(PilotPath, RestsWhereThePointRestsAndFollowsItWhereItMoves) {
  const auto truth = testing::sampled(170, 100.0, testing::reach);
  const auto recording = recording_of(truth, 0.001);
  const auto pilot = pilot_path(recording, 9, 152, 1, 1);
  const auto smooth = smoothed(recording, 1.0);
  EXPECT_LT(path_length(pilot.middleRows(10, 30)), 0.3 * path_length(smooth.middleRows(10, 30)));
  EXPECT_NEAR(path_length(pilot.middleRows(60, 50)), path_length(smooth.middleRows(60, 50)), 0.002);
  EXPECT_LT((pilot - truth).rowwise().norm().maxCoeff(), 0.004);
}

TEST(PilotPath, LiesInItsPlane) {
  const auto recording = recording_of(testing::sampled(300, 100.0, testing::ellipse), 0.002);
  const auto pilot = pilot_path(recording, 9, 282, 1, 1);
  const auto smooth = smoothed(recording, 1.0);
  const double before = std::sqrt(principal_axes(smooth.middleRows(9, 282)).variance[2]);
  EXPECT_LT(std::sqrt(principal_axes(pilot.middleRows(9, 282)).variance[2]), 0.7 * before);
}

TEST(Refits, AreTheSameWhateverTheirNumber) {
  const auto truth = testing::sampled(120, 100.0, testing::ellipse);
  const auto recording = recording_of(truth, 0.001);
  std::vector<SeriesMatrix> few, many;
  for_each_refit(recording, truth, 5, 1, 7,
                 [&](std::int64_t, const SeriesMatrix& less, const SeriesMatrix&) { few.push_back(less); });
  for_each_refit(recording, truth, 40, 1, 7,
                 [&](std::int64_t, const SeriesMatrix& less, const SeriesMatrix&) { many.push_back(less); });
  ASSERT_EQ(few.size(), 5u);
  ASSERT_EQ(many.size(), 40u);
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_EQ(few[k], many[k]) << k;
}

TEST(Refits, HaveNoiseAsItLiesAlongTheAxes) {
  const auto truth = testing::sampled(400, 100.0, testing::ellipse);
  auto recording = recording_of(truth, 0.001);
  recording.x.col(2) = truth.col(2) + 3.0 * (recording.x.col(2) - truth.col(2));
  recording.noise_sd_m = 0.001 * std::sqrt(11.0 / 3.0);
  recording.noise_shape = noise_shape(recording, smoothed(recording, kLessSmooth));
  const Eigen::MatrixXd covariance = recording.noise_shape * recording.noise_shape;
  EXPECT_NEAR(covariance.trace(), 3.0, 1e-9);
  EXPECT_NEAR(covariance(2, 2) / covariance(0, 0), 9.0, 2.5);
  EXPECT_NEAR(covariance(0, 2), 0.0, 0.2);
  SeriesMatrix across = SeriesMatrix::Zero(400, 3);
  across = with_noise(across, recording, 1, 2, 3);
  EXPECT_NEAR(across.col(2).norm() / across.col(0).norm(), std::sqrt(covariance(2, 2) / covariance(0, 0)),
              0.3);
  // Of noise that is alike along the axes nothing is said.
  const auto alike = recording_of(truth, 0.001);
  EXPECT_EQ(noise_shape(alike, smoothed(alike, kLessSmooth)).size(), 0);
}

TEST(Refits, AreDisplacedWithTheRoom) {
  const auto truth = testing::sampled(120, 100.0, testing::ellipse);
  const auto recording = recording_of(truth, 0.001);
  RefitNumbers numbers{.count = 40, .seed = 1, .stream = 7};
  std::vector<SeriesMatrix> plain, displaced;
  const auto keep = [](std::vector<SeriesMatrix>& to) {
    return [&to](const RefitBatch& batch) {
      for (std::int64_t k = 0; k < batch.count; ++k) to.emplace_back(batch.less.middleCols(3 * k, 3));
    };
  };
  for_each_batch(recording, truth, numbers, keep(plain));
  numbers.displacements = {0.01 * truth, SeriesMatrix::Constant(truth.rows(), 3, 0.02)};
  for_each_batch(recording, truth, numbers, keep(displaced));
  double scales = 0.0, shifts = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const SeriesMatrix moved = displaced[k] - plain[k];
    const double scale = (moved(30, 0) - moved(0, 0)) / (0.01 * (truth(30, 0) - truth(0, 0)));
    const double shift = (moved(0, 0) - scale * 0.01 * truth(0, 0)) / 0.02;
    EXPECT_LT((moved - scale * numbers.displacements[0] - shift * numbers.displacements[1]).norm(), 1e-12);
    scales += scale * scale / 40.0, shifts += shift * shift / 40.0;
  }
  EXPECT_NEAR(scales, 1.0, 0.5);
  EXPECT_NEAR(shifts, 1.0, 0.5);
}

TEST(Refits, ScatterAsTheRecordingDoes) {
  // Around the truth itself: deviations of refits have the size of the recording's own.
  const auto truth = testing::sampled(300, 100.0, testing::ellipse);
  const auto recording = recording_of(truth, 0.001);
  const double own = (smoothed(recording, kLessSmooth) - truth).norm();
  double mean = 0.0, least = 0.0;
  for_each_refit(recording, truth, 40, 1, 7, [&](std::int64_t, const SeriesMatrix& a, const SeriesMatrix& b) {
    mean += (a - truth).norm() / 40.0;
    least += (b - truth).norm() / 40.0;
  });
  EXPECT_NEAR(own / mean, 1.0, 0.25);
  EXPECT_GT(least, mean);  // smoothed less, more noise is left
}

}  // namespace
}  // namespace kinemark::analysis

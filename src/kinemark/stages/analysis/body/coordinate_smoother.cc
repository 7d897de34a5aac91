// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/coordinate_smoother.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kLeastSamples = 30;
constexpr double kLowestCutOff_hz = 0.4;
constexpr double kHighestCutOff = 0.45;  // cycles per sample
constexpr double kNoNoise = 1e-9;        // of the range: what rounding leaves of sixth differences
constexpr double kMoreThanWhite = 1.15;  // stated over white
constexpr int kCosines = 16;
constexpr double kPoseShare = 2.0 / 3, kRateShare = 1.0 / 6;  // of the variance of slow errors
constexpr std::uint64_t kSlowStream = 1ULL << 61;

// Expected rate of passes through the mean over 2 of a Gaussian series of that power: Rice 1945.
double mean_frequency_hz(const Eigen::VectorXd& q, double rate_hz) {
  const double mean = q.mean(), variance = (q.array() - mean).square().sum();
  if (!(variance > 0.0)) return 0.0;
  const auto n = q.size();
  const double steps = (q.tail(n - 1) - q.head(n - 1)).squaredNorm();
  return rate_hz * std::sqrt(steps / variance) / (2.0 * std::numbers::pi);
}

// Of mean 0 and variance 1; 0 where it is constant.
Eigen::VectorXd standardized(const Eigen::VectorXd& x) {
  const Eigen::VectorXd level = x.array() - x.mean();
  const double size = std::sqrt(level.squaredNorm() / static_cast<double>(x.size()));
  return size > 0.0 ? Eigen::VectorXd(level / size) : Eigen::VectorXd::Zero(x.size());
}

// Samples that are not seen on straight lines between those that are.
void fill(Eigen::VectorXd& q, const std::vector<bool>& seen) {
  std::int64_t last = -1;
  for (std::int64_t i = 0; i <= q.size(); ++i) {
    if (i < q.size() && !seen[at(i)]) continue;
    for (std::int64_t k = last + 1; k < i; ++k) {
      const double share = static_cast<double>(k - last) / static_cast<double>(i - last);
      q[k] = last < 0 ? q[i] : i == q.size() ? q[last] : (1.0 - share) * q[last] + share * q[i];
    }
    last = i;
  }
}

}  // namespace

std::expected<CoordinateSmoother, std::string> CoordinateSmoother::create(const Eigen::VectorXd& q,
                                                                          std::vector<bool> seen,
                                                                          double stated, double rate_hz) {
  const auto count = std::ranges::count(seen, true);
  if (count < kLeastSamples)
    return std::unexpected(
        fmt::format("{} of its samples are determined, {} are needed", count, kLeastSamples));
  CoordinateSmoother out;
  auto& recording = out.recording_;
  Eigen::VectorXd filled = q;
  fill(filled, seen);
  const double range = filled.maxCoeff() - filled.minCoeff();
  recording.x = filled;
  recording.rate_hz = rate_hz;
  const double white = math::noise_from_differences(recording.x, seen);
  recording.seen = std::move(seen);
  out.less_ = out.pilot_ = filled;
  if (white > kNoNoise * range && white > 0.0) {
    const SeriesMatrix scaled = recording.x / white;
    const auto choice =
        math::choose_smoothing(scaled, recording.seen, {.lowest = std::min(kLowestCutOff_hz / rate_hz, 0.1)});
    if (!choice) return std::unexpected(std::string("no smoother fits its samples"));
    recording.noise_sd_m = out.noise_.white = white;
    recording.choice = *choice;
    out.cut_off_hz_ = choice->half_power * rate_hz;
    out.smoother_.emplace(recording.seen, choice->order);
    if (!out.smoother_->factor(std::min(kHighestCutOff, kLessSmooth * choice->half_power)))
      return std::unexpected(std::string("no smoother fits its samples"));
    out.less_ = smoothed(recording, kLessSmooth).col(0);
    out.pilot_ = pilot_path(recording, 0, recording.x.rows(), 1, 0).col(0);
  }
  if (stated > kMoreThanWhite * out.noise_.white)
    out.noise_.slow = std::sqrt(stated * stated - out.noise_.white * out.noise_.white);
  out.movement_hz_ = mean_frequency_hz(out.less_, rate_hz);
  return out;
}

Eigen::VectorXd CoordinateSmoother::slow_errors(std::uint64_t seed, std::uint64_t stream,
                                                std::int64_t k) const {
  Random random(seed, mix64(stream ^ kSlowStream) ^ static_cast<std::uint64_t>(k));
  const auto n = recording_.x.rows();
  // Of variance 1: the pose, its rate, and what has neither's course.
  const Eigen::VectorXd& q = pilot_;
  Eigen::VectorXd rate(n);
  for (std::int64_t f = 0; f < n; ++f)
    rate[f] = q[std::min(n - 1, f + 1)] - q[std::max<std::int64_t>(0, f - 1)];
  Eigen::VectorXd drift = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < kCosines; ++i) {
    const double hz = random.uniform(0.25, 2.0) * movement_hz_;
    const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double step = 2.0 * std::numbers::pi * hz / recording_.rate_hz;
    for (std::int64_t f = 0; f < n; ++f)
      drift[f] += std::sqrt(2.0 / kCosines) * std::cos(step * static_cast<double>(f) + phase);
  }
  const double of_pose = random.gaussian(), of_rate = random.gaussian(), of_drift = random.gaussian();
  return noise_.slow * (std::sqrt(kPoseShare) * of_pose * standardized(q) +
                        std::sqrt(kRateShare) * of_rate * standardized(rate) +
                        std::sqrt(1.0 - kPoseShare - kRateShare) * of_drift * drift);
}

Eigen::VectorXd CoordinateSmoother::refit(std::uint64_t seed, std::uint64_t stream, std::int64_t k) const {
  SeriesMatrix out = pilot_;
  if (noise_.slow > 0.0) out.col(0) += slow_errors(seed, stream, k);
  if (!smoother_) return out.col(0);
  out = with_noise(out, recording_.seen, noise_.white, seed, stream, k);
  smoother_->smooth(out);
  return out.col(0);
}

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/coordinate_smoother.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
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
constexpr double kPoseShare = 1.0 / 3, kOthersShare = 1.0 / 3,
                 kRateShare = 1.0 / 6;  // of the variance of slow errors
constexpr std::uint64_t kSlowStream = 1ULL << 61;

// Expected rate of passes through the mean over 2 of a Gaussian series of that power: Rice 1945.
double mean_frequency_hz(const Eigen::VectorXd& q, double rate_hz) {
  const double mean = q.mean(), variance = (q.array() - mean).square().sum();
  if (!(variance > 0.0)) return 0.0;
  const auto n = q.size();
  const double steps = (q.tail(n - 1) - q.head(n - 1)).squaredNorm();
  return rate_hz * std::sqrt(steps / variance) / (2.0 * std::numbers::pi);
}

// Mean square of the steps from sample to sample that a smoother leaves of white noise of variance 1.
double noise_of_steps(int order, double half_power) {
  constexpr int kParts = 256;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double f = 0.5 * (i + 0.5) / kParts,
                 gain = math::gain_of(math::LowPass::spline, order, half_power, f);
    sum += std::pow(2.0 * gain * std::sin(std::numbers::pi * f), 2) / kParts;
  }
  return sum;
}

// Stretches that are searched for rest, s, and how much more than noise their steps may hold on average: of
// noise alone a longer one holds less by chance.
struct RestWindow {
  double length_s, most;
};
constexpr double kBegins_s = 0.1;  // to both sides of where rest ends
constexpr std::array kRestWindows{RestWindow{0.3, 3.0}, RestWindow{0.6, 2.0}};

// Whether each step lies in a stretch that moves by no more than noise does.
std::vector<bool> steps_at_rest(const Eigen::VectorXd& steps, double noise, double rate_hz) {
  std::vector<bool> out(at(steps.size()), false);
  for (const auto& window : kRestWindows) {
    const auto count = static_cast<Eigen::Index>(std::ceil(window.length_s * rate_hz));
    if (count > steps.size()) continue;
    double energy = steps.head(count).squaredNorm();
    for (Eigen::Index first = 0;; ++first) {
      if (energy < window.most * noise * static_cast<double>(count))
        std::fill_n(out.begin() + first, count, true);
      if (first + count == steps.size()) break;
      energy += steps[first + count] * steps[first + count] - steps[first] * steps[first];
    }
  }
  return out;
}

// The pilot without its steps where the smoothed coordinate rests; its mean stays. Movement begins and ends
// gradually, as a step of the velocity would be an acceleration that nobody saw.
Eigen::VectorXd rested(const Eigen::VectorXd& pilot, const Eigen::VectorXd& smooth, double noise,
                       double rate_hz) {
  const auto n = pilot.size();
  const auto rests = steps_at_rest(smooth.tail(n - 1) - smooth.head(n - 1), noise, rate_hz);
  const auto half = static_cast<Eigen::Index>(std::ceil(kBegins_s * rate_hz));
  Eigen::VectorXd out = pilot;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    double moving = 0.0, all = 0.0;
    for (Eigen::Index k = -half; k <= half; ++k) {
      if (i + k < 0 || i + k + 1 >= n) continue;
      const double weight =
          1.0 + std::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(half + 1));
      all += weight;
      if (!rests[at(i + k)]) moving += weight;
    }
    out[i + 1] = out[i] + moving / all * (pilot[i + 1] - pilot[i]);
  }
  return out.array() + (pilot.mean() - out.mean());
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

Eigen::VectorXd standardized(const Eigen::VectorXd& x) {
  const Eigen::VectorXd level = x.array() - x.mean();
  const double size = std::sqrt(level.squaredNorm() / static_cast<double>(x.size()));
  return size > 0.0 ? Eigen::VectorXd(level / size) : Eigen::VectorXd::Zero(x.size());
}

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
    // White noise that is modelled: the pilot is then flat where little more than noise is seen.
    const math::NoiseModel model{.variance = white * white};
    recording.noise = std::make_shared<ColouredNoise>(ColouredNoise{.model = model, .draws = {model}});
    const double noise = white * white * noise_of_steps(choice->order, choice->half_power);
    out.pilot_ = rested(pilot_path(recording, 0, recording.x.rows(), 1, 0).col(0),
                        smoothed(recording, 1.0).col(0), noise, rate_hz);
  }
  if (stated > kMoreThanWhite * out.noise_.white)
    out.noise_.slow = std::sqrt(stated * stated - out.noise_.white * out.noise_.white);
  out.movement_hz_ = mean_frequency_hz(out.less_, rate_hz);
  return out;
}

void CoordinateSmoother::move_beside(std::shared_ptr<const Eigen::MatrixXd> poses, Eigen::Index own) {
  poses_ = std::move(poses);
  own_pose_ = own;
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
  Eigen::VectorXd beside = Eigen::VectorXd::Zero(n);
  double moving = 0.0;
  if (poses_)
    for (Eigen::Index c = 0; c < poses_->cols(); ++c)
      if (c != own_pose_ && !poses_->col(c).isZero())
        beside += random.gaussian() * poses_->col(c), moving += 1.0;
  if (moving > 0.0)
    beside /= std::sqrt(moving);
  else
    beside = random.gaussian() * standardized(q);
  return noise_.slow * (std::sqrt(kPoseShare) * of_pose * standardized(q) + std::sqrt(kOthersShare) * beside +
                        std::sqrt(kRateShare) * of_rate * standardized(rate) +
                        std::sqrt(1.0 - kPoseShare - kOthersShare - kRateShare) * of_drift * drift);
}

Eigen::VectorXd CoordinateSmoother::smoothed_pilot() const {
  SeriesMatrix out = pilot_;
  if (smoother_) smoother_->smooth(out);
  return out.col(0);
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

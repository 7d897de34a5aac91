// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/local_bias.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kTail = 0.02;      // of the largest value, below which the pattern ends
constexpr double kSurely = 5.0;     // natural logarithm of how much likelier jumps are than none
constexpr double kLeastJump = 4.0;  // variance of jumps over that of noise
constexpr double kMostJumps = 0.1;  // of the frames
constexpr int kTurns = 30;          // of EM

/// What the filter takes from a ramp that begins at a frame.
struct RampLoss {
  std::int64_t reach = 0;     // frames on either side
  std::vector<double> taken;  // 2 reach + 1, for a jump of 1 m a frame
  double power = 0.0;         // sum of squares
  double noise = 0.0;         // sum of squares of what the filter's remainder of it weighs noise with
};

RampLoss loss_of_ramp(std::span<const double> response) {
  const auto middle = std::ssize(response) / 2;
  std::vector<double> rest(response.size()), taken(response.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = -response[i];
  rest[at(middle)] += 1.0;
  double once = 0.0, twice = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    taken[i] = twice;
    once += rest[i], twice += once;
  }
  double most = 0.0;
  for (const double t : taken) most = std::max(most, std::abs(t));
  RampLoss out;
  for (std::int64_t i = 0; i < std::ssize(taken); ++i)
    if (std::abs(taken[at(i)]) > kTail * most) out.reach = std::max(out.reach, std::abs(i - middle));
  for (auto i = middle - out.reach; i <= middle + out.reach; ++i) {
    out.taken.push_back(taken[at(i)]);
    out.power += taken[at(i)] * taken[at(i)];
  }
  for (std::int64_t i = 0; i < std::ssize(response); ++i) {
    double sum = 0.0;
    for (auto k = -out.reach; k <= out.reach; ++k)
      if (const auto lag = i - k; lag >= 0 && lag < std::ssize(response))
        sum += out.taken[at(k + out.reach)] * rest[at(lag)];
    out.noise += sum * sum;
  }
  return out;
}

/// The size of the pattern about one frame, by least squares, and its variance by noise; none where less than
/// half of it is seen.
struct Jump {
  Eigen::Array3d size = Eigen::Array3d::Zero();
  Eigen::Array3d variance = Eigen::Array3d::Zero();
  double square = -1.0;  // chi-square; below 0: not seen
};

std::vector<Jump> jumps_of(const MarkerSamples& samples, const MarkerResult& result,
                           const RampLoss& pattern) {
  const double noise = result.account.used.noise_sd_m;
  std::vector<Jump> out(at(samples.frames));
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    Jump& jump = out[at(f)];
    double seen = 0.0, count = 0.0;
    Eigen::Array3d own = Eigen::Array3d::Zero();
    for (auto k = -pattern.reach; k <= pattern.reach; ++k) {
      const auto g = f + k;
      if (g < 0 || g >= samples.frames || samples.judged[at(g)] == 0 || std::isnan(result.x[at(3 * g)]))
        continue;
      const double weight = pattern.taken[at(k + pattern.reach)];
      seen += weight * weight, count += 1.0;
      for (int axis = 0; axis < 3; ++axis) {
        jump.size[axis] += weight * (samples.x[at(3 * g + axis)] - result.x[at(3 * g + axis)]);
        own[axis] += samples.variance.empty() ? 1.0 : samples.variance[at(axis * samples.frames + g)];
      }
    }
    if (seen < 0.5 * pattern.power) continue;
    jump.size /= seen;
    jump.variance = noise * noise * pattern.noise / (seen * seen) * (own / count);
    jump.square = (jump.size.square() / jump.variance).sum();
  }
  return out;
}

/// Expected squares of what jumps there are, per frame and axis; empty where noise explains all.
std::vector<Eigen::Array3d> expected_squares(const std::vector<Jump>& jumps) {
  double share = 0.02, size = 20.0;  // of frames with a jump; its variance over that of noise
  std::vector<double> chance(jumps.size(), 0.0);
  double gain = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    gain = 0.0;
    for (std::size_t f = 0; f < jumps.size(); ++f) {
      if (jumps[f].square < 0.0) continue;
      const double ratio = 0.5 * jumps[f].square * size / (1.0 + size) - 1.5 * std::log1p(size);
      const double log_odds = std::log(share / (1.0 - share)) + ratio;
      chance[f] = 1.0 / (1.0 + std::exp(-log_odds));
      // log((1 - share) + share exp(ratio)), which must not overflow
      gain += std::log1p(-share) + std::max(0.0, log_odds) + std::log1p(std::exp(-std::abs(log_odds)));
      sum += chance[f], squares += chance[f] * jumps[f].square, count += 1.0;
    }
    if (!(sum > 0.0)) return {};
    share = std::clamp(sum / count, 1e-4, kMostJumps);
    size = std::max(kLeastJump, squares / (3.0 * sum) - 1.0);
  }
  if (!(gain > kSurely)) return {};
  const double kept = size / (1.0 + size);
  std::vector<Eigen::Array3d> out;
  for (std::size_t f = 0; f < jumps.size(); ++f)
    out.push_back(chance[f] * (kept * kept * jumps[f].size.square() + kept * jumps[f].variance));
  return out;
}

}  // namespace

void add_local_bias(const MarkerSamples& samples, std::span<const double> response, MarkerResult& result) {
  const data::FilterUsed& used = result.account.used;
  if (response.empty() || result.covariance.empty() || !(used.noise_sd_m > 0.0) || !(used.cutoff_hz > 0.0))
    return;
  const auto pattern = loss_of_ramp(response);
  if (!(pattern.power > 0.0)) return;
  const auto squares = expected_squares(jumps_of(samples, result, pattern));
  if (squares.empty()) return;
  const double per_order = std::pow(2.0 * M_PI * used.cutoff_hz, 2);
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    Eigen::Array3d extra = Eigen::Array3d::Zero();
    for (auto k = -pattern.reach; k <= pattern.reach; ++k)
      if (const auto g = f - k; g >= 0 && g < samples.frames)
        extra = extra.max(squares[at(g)] * std::pow(pattern.taken[at(k + pattern.reach)], 2));
    for (int axis = 0; axis < 3; ++axis) {
      double variance = extra[axis];
      if (!(variance > 0.0)) continue;
      result.covariance[at(6 * f) + math::kSymmetric3Diagonal[at(axis)]] += variance;
      for (Array<double>* sd : {&result.velocity_sd, &result.acceleration_sd, &result.jerk_sd}) {
        variance *= per_order;
        if (!sd->empty()) (*sd)[at(3 * f + axis)] = std::hypot((*sd)[at(3 * f + axis)], std::sqrt(variance));
      }
    }
  }
}

}  // namespace kinemark::trajectory::smoothing

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/cutoff.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/math/digital_filter.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kLowestHz = 1.0, kHighestShare = 0.25;  ///< cut-offs tried, up to a quarter of the rate
constexpr double kNoiseFrom = 0.6;                       ///< of the highest cut-off: only noise is left above
constexpr double kMemory = 1.2;                          ///< periods of the cut-off until an end is forgotten
constexpr int kLags = 10;
constexpr int kSteps = 96;

/// Cut-offs tried; slow recordings begin below 1 Hz.
std::vector<double> grid(double rate_hz, int steps) {
  const double high = kHighestShare * rate_hz, low = std::min(kLowestHz, 0.04 * high);
  std::vector<double> cutoffs;
  for (int i = 0; i <= steps; ++i) cutoffs.push_back(low + (high - low) * i / steps);
  return cutoffs;
}

std::vector<double> residual(const std::vector<double>& x, const CutoffProblem& problem, double cutoff_hz) {
  std::vector<double> r = x;
  butterworth(r, problem.order, cutoff_hz, problem.rate_hz, true);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = x[i] - r[i];
  return r;
}

}  // namespace

void butterworth(std::vector<double>& x, int order, double cutoff_hz, double rate_hz, bool corrected) {
  const double cutoff = cutoff_hz / rate_hz;
  const int memory = static_cast<int>(std::min(1e6, std::ceil(kMemory * order / cutoff)));
  const int padding = corrected ? std::max(math::usual_padding(order), memory) : math::usual_padding(order);
  const auto sections =
      math::butterworth_lowpass(order, corrected ? math::two_pass_cutoff(order, cutoff) : cutoff);
  math::filter_both_ways(sections, padding, x);
}

double winter_cutoff_hz(const CutoffProblem& problem) {
  const std::vector<double> cutoffs = grid(problem.rate_hz, kSteps / 2);
  std::vector<double> rms;
  for (const double cutoff : cutoffs) {
    double sum = 0.0, count = 0.0;
    for (const auto& x : problem.columns) {
      for (const double r : residual(x, problem, cutoff)) sum += r * r;
      count += static_cast<double>(x.size());
    }
    rms.push_back(std::sqrt(sum / std::max(count, 1.0)));
  }
  // Straight line through the upper part: value at zero.
  double n = 0.0, sf = 0.0, sr = 0.0, sff = 0.0, sfr = 0.0;
  for (std::size_t i = 0; i < cutoffs.size(); ++i) {
    if (cutoffs[i] < kNoiseFrom * cutoffs.back()) continue;
    n += 1.0;
    sf += cutoffs[i];
    sr += rms[i];
    sff += cutoffs[i] * cutoffs[i];
    sfr += cutoffs[i] * rms[i];
  }
  const double slope = (n * sfr - sf * sr) / (n * sff - sf * sf);
  const double noise = (sr - slope * sf) / n;
  for (std::size_t i = 0; i < cutoffs.size(); ++i) {
    if (rms[i] > noise) continue;
    if (i == 0 || rms[i - 1] == rms[i]) return cutoffs[i];
    return cutoffs[i - 1] + (cutoffs[i] - cutoffs[i - 1]) * (rms[i - 1] - noise) / (rms[i - 1] - rms[i]);
  }
  return cutoffs.back();
}

double challis_cutoff_hz(const CutoffProblem& problem) {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (const double cutoff : grid(problem.rate_hz, kSteps)) {
    double sum = 0.0;
    for (const auto& x : problem.columns) {
      std::vector<double> r = residual(x, problem, cutoff);
      double mean = 0.0, power = 0.0;
      for (const double v : r) mean += v / static_cast<double>(r.size());
      for (double& v : r) {
        v -= mean;
        power += v * v;
      }
      if (power <= 0.0) continue;
      for (std::size_t lag = 1; lag <= kLags && lag < r.size(); ++lag) {
        double product = 0.0;
        for (std::size_t i = lag; i < r.size(); ++i) product += r[i] * r[i - lag];
        sum += product * product / (power * power) * static_cast<double>(r.size());
      }
    }
    if (sum >= least) continue;
    least = sum;
    best = cutoff;
  }
  return best;
}

}  // namespace kinemark::trajectory::smoothing

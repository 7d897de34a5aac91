// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/rails.h"

#include <algorithm>

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLeastAtRail = 8.0;  // samples at a rail
constexpr double kBesideRail = 0.01;  // of the range, where the tail is looked at
constexpr double kHeapAtRail = 2.0;   // times what the tail holds there
constexpr double kLasting_s = 0.025;  // half a period of 20 Hz: no muscle stays at one value for longer

// Samples at the largest value, or 0 where that is no rail.
double heaped_at_most(const VectorXd& x, double rate_hz) {
  const double most = x.maxCoeff(), range = most - x.minCoeff();
  double next = x.minCoeff();
  for (const double v : x)
    if (v < most) next = std::max(next, v);
  const double beside = std::min(next, most - kBesideRail * range);
  double at = 0.0, runs = 0.0, tail = 0.0;
  for (Index i = 0; i < x.size(); ++i) {
    if (x[i] == most) at += 1.0, runs += i == 0 || x[i - 1] != most ? 1.0 : 0.0;
    if (x[i] < most && x[i] >= beside) tail += 1.0;
  }
  return at >= kLeastAtRail && at > kHeapAtRail * tail && at <= kLasting_s * rate_hz * runs ? at : 0.0;
}

}  // namespace

Rails find_rails(const VectorXd& volts, double rate_hz) {
  Rails out;
  const double high = heaped_at_most(volts, rate_hz), low = heaped_at_most(-volts, rate_hz);
  if (high > 0.0) out.high = volts.maxCoeff();
  if (low > 0.0) out.low = volts.minCoeff();
  out.share = (high + low) / static_cast<double>(volts.size());
  return out;
}

}  // namespace kinemark::analysis

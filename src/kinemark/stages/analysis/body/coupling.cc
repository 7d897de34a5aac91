// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/coupling.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

constexpr Eigen::Index kLeast = 8;
constexpr double kMoves = 0.1;  // of the longest step: shorter ones have the direction of noise

bool is_constant(const VectorXd& x) { return !(x.maxCoeff() > x.minCoeff()); }

double pearson(const Eigen::Ref<const VectorXd>& a, const Eigen::Ref<const VectorXd>& b) {
  const VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  const double size = x.norm() * y.norm();
  return size > 0.0 ? x.dot(y) / size : 0.0;
}

// Of the samples that overlap where b is `lag` samples late.
double correlation_at(const VectorXd& a, const VectorXd& b, Eigen::Index lag) {
  const auto n = a.size() - std::abs(lag);
  return lag >= 0 ? pearson(a.head(n), b.tail(n)) : pearson(a.tail(n), b.head(n));
}

}  // namespace

VectorXd hilbert_phase(const VectorXd& x) {
  const auto n = x.size();
  const double middle = 0.5 * (x.maxCoeff() + x.minCoeff());
  std::vector<std::complex<double>> signal(at(n)), spectrum;
  for (Eigen::Index i = 0; i < n; ++i) signal[at(i)] = x[i] - middle;
  Eigen::FFT<double> transform;
  transform.fwd(spectrum, signal);
  for (Eigen::Index k = 1; k < n; ++k)
    if (2 * k < n)
      spectrum[at(k)] *= 2.0;
    else if (2 * k > n)
      spectrum[at(k)] = 0.0;
  transform.inv(signal, spectrum);
  VectorXd out(n);
  for (Eigen::Index i = 0; i < n; ++i) out[i] = std::arg(signal[at(i)]);
  return out;
}

RelativePhase relative_phase(const VectorXd& a, const VectorXd& b) {
  if (a.size() < kLeast || is_constant(a) || is_constant(b)) return {};
  const VectorXd first = hilbert_phase(a), second = hilbert_phase(b);
  std::complex<double> sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += std::polar(1.0, first[i] - second[i]);
  return {.mean = std::arg(sum), .locking = std::abs(sum) / static_cast<double>(a.size())};
}

VectorXd correlations(const VectorXd& a, const VectorXd& b) {
  if (a.size() < kLeast || is_constant(a) || is_constant(b)) return {};
  const Eigen::Index most = a.size() / 4;
  VectorXd r(2 * most + 1);
  for (Eigen::Index lag = -most; lag <= most; ++lag) r[lag + most] = correlation_at(a, b, lag);
  return r;
}

CrossCorrelation cross_correlation(const VectorXd& a, const VectorXd& b) {
  const VectorXd r = correlations(a, b);
  if (r.size() == 0) return {};
  const Eigen::Index most = r.size() / 2;
  Eigen::Index best = 0;
  const double size = r.array().abs().maxCoeff(&best);
  CrossCorrelation out{.lag = static_cast<double>(best - most), .correlation = r[best]};
  if (best == 0 || best == 2 * most) return out;
  const double sign = r[best] < 0.0 ? -1.0 : 1.0;
  const double before = sign * r[best - 1], after = sign * r[best + 1];
  const double curvature = before - 2.0 * size + after;
  if (curvature < 0.0) out.lag += 0.5 * (before - after) / curvature;
  return out;
}

std::array<double, 4> coordination_shares(const VectorXd& a, const VectorXd& b) {
  std::array<double, 4> out{};
  double count = 0.0, longest = 0.0;
  for (Eigen::Index i = 0; i + 1 < a.size(); ++i)
    longest = std::max(longest, std::hypot(a[i + 1] - a[i], b[i + 1] - b[i]));
  for (Eigen::Index i = 0; i + 1 < a.size(); ++i) {
    const double x = a[i + 1] - a[i], y = b[i + 1] - b[i];
    if (!(std::hypot(x, y) > kMoves * longest)) continue;
    // Directions a half turn apart are the same pattern: 0 a alone, 1 alike, 2 b alone, 3 contrary.
    const double eighths = std::atan2(y, x) / (std::numbers::pi / 4.0);
    const auto sector = (static_cast<int>(std::lround(eighths)) + 8) % 4;
    constexpr std::array kPlace{2, 0, 3, 1};
    out[at(kPlace[at(sector)])] += 1.0;
    count += 1.0;
  }
  for (double& share : out) share = count > 0.0 ? share / count : kNaN;
  return out;
}

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/timing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/path/spectrum.h"

namespace kinemark::analysis {
namespace {

// n values from -(n-1)/2 to (n-1)/2.
Eigen::VectorXd centred_index(std::int64_t n) {
  return Eigen::VectorXd::LinSpaced(n, -0.5 * static_cast<double>(n - 1), 0.5 * static_cast<double>(n - 1));
}

// The least even number from n on without a prime factor above 5: its transform is quick.
std::int64_t quick_length(std::int64_t n) {
  for (std::int64_t length = n + n % 2;; length += 2) {
    std::int64_t rest = length;
    for (const std::int64_t prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return length;
  }
}

}  // namespace

Eigen::VectorXd speed_of(const PathSamples& path) { return path.v.rowwise().norm(); }

MovementWindow movement_window(const Eigen::VectorXd& speed, double rate_hz) {
  MovementWindow out;
  const auto hold = std::max<std::int64_t>(2, std::llround(kMovingHold_s * rate_hz));
  const std::int64_t n = speed.size();
  if (n == 0) return out;
  const double level = kMovingShare * speed.maxCoeff();
  std::int64_t first = -1, last = -1, run = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    run = speed[i] > level ? run + 1 : 0;
    if (run < hold) continue;
    if (first < 0) first = i - run + 1;
    last = i;
  }
  const auto crossing = [&](std::int64_t below, std::int64_t above) {
    const double share = (speed[above] - level) / (speed[above] - speed[below]);
    return (static_cast<double>(above) + share * static_cast<double>(below - above)) / rate_hz;
  };
  if (first > 0) out.onset_s = crossing(first - 1, first);
  if (last >= 0 && last + 1 < n) out.end_s = crossing(last + 1, last);
  return out;
}

std::int64_t count_submovements(const Eigen::VectorXd& speed) {
  const std::int64_t n = speed.size();
  const double peak = n > 0 ? speed.maxCoeff() : 0.0;
  std::int64_t count = 0;
  for (std::int64_t i = 1; i + 1 < n; ++i) {
    if (!(speed[i] > speed[i - 1]) || speed[i] < 0.1 * peak) continue;
    std::int64_t behind = i;  // past a flat top
    while (behind + 1 < n && speed[behind + 1] == speed[i]) ++behind;
    if (behind + 1 >= n || !(speed[behind + 1] < speed[i])) continue;
    double left = speed[i], right = speed[i];  // lowest until something is higher
    for (std::int64_t k = i - 1; k >= 0 && speed[k] <= speed[i]; --k) left = std::min(left, speed[k]);
    for (std::int64_t k = behind + 1; k < n && speed[k] <= speed[i]; ++k) right = std::min(right, speed[k]);
    count += speed[i] - std::max(left, right) >= 0.05 * peak;
  }
  return count;
}

double time_to_peak(const Eigen::VectorXd& speed, double rate_hz) {
  if (speed.size() == 0) return kNaN;
  Eigen::Index at = 0;
  speed.maxCoeff(&at);
  return static_cast<double>(at) / rate_hz;
}

SeriesMatrix without_trend(const SeriesMatrix& x) {
  const Eigen::VectorXd t = centred_index(x.rows());
  SeriesMatrix out = x.rowwise() - x.colwise().mean().eval();
  if (x.rows() > 1) out -= t * (t.transpose() * out).eval() / t.squaredNorm();
  return out;
}

Eigen::Vector3d detrended_axis(const SeriesMatrix& x) {
  const SeriesMatrix level = without_trend(x);
  const Eigen::Matrix3d spread = level.transpose() * level;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

std::vector<double> cycle_starts(const SeriesMatrix& x, const Eigen::Vector3d& axis, double rate_hz) {
  const SeriesMatrix along = x * axis;
  const Eigen::VectorXd z = without_trend(along);
  std::vector<double> crossings;
  for (std::int64_t i = 0; i + 1 < z.size(); ++i)
    if (z[i] < 0.0 && z[i + 1] >= 0.0)
      crossings.push_back((static_cast<double>(i) - z[i] / (z[i + 1] - z[i])) / rate_hz);
  return crossings;
}

Cycles cycles_along(const SeriesMatrix& x, const Eigen::Vector3d& axis, double rate_hz) {
  const auto crossings = cycle_starts(x, axis, rate_hz);
  std::vector<double> lengths;
  for (std::size_t i = 1; i < crossings.size(); ++i) lengths.push_back(crossings[i] - crossings[i - 1]);
  if (lengths.size() > 1) {
    const double least = 0.4 * math::median(lengths);
    std::erase_if(lengths, [least](double s) { return s <= least; });
  }
  Cycles out{.count = static_cast<std::int64_t>(lengths.size())};
  if (lengths.empty()) return out;
  const double count = static_cast<double>(lengths.size());
  double sum = 0.0, squares = 0.0;
  for (const double s : lengths) sum += s;
  out.mean_s = sum / count;
  for (const double s : lengths) squares += (s - out.mean_s) * (s - out.mean_s);
  if (lengths.size() > 1) out.sd_s = std::sqrt(squares / (count - 1.0));
  return out;
}

Periodogram periodogram_of(const SeriesMatrix& x, double rate_hz) {
  const std::int64_t n = x.rows();
  if (n < 8) return {};
  const Eigen::VectorXd window = (0.5 - 0.5 * ((centred_index(n).array() + 0.5 * static_cast<double>(n - 1)) *
                                               (2.0 * M_PI / static_cast<double>(n - 1)))
                                                  .cos())
                                     .matrix();
  const std::int64_t length = quick_length(n);
  const SeriesMatrix level = without_trend(x);
  Periodogram out{.step_hz = rate_hz / static_cast<double>(length),
                  .per_mean_square = 2.0 / (window.squaredNorm() * static_cast<double>(length)),
                  .power = Eigen::VectorXd::Zero(length / 2 + 1)};
  for (Eigen::Index axis = 0; axis < x.cols(); ++axis)
    out.power += amplitudes(level.col(axis).cwiseProduct(window), length).array().square().matrix();
  return out;
}

double band_rms(const Periodogram& of, double low_hz, double high_hz) {
  if (of.power.size() == 0) return kNaN;
  double sum = 0.0;
  for (std::int64_t k = 0; k < of.power.size(); ++k) {
    const double frequency = static_cast<double>(k) * of.step_hz;
    if (frequency >= low_hz && frequency <= high_hz) sum += of.power[k];
  }
  return std::sqrt(of.per_mean_square * sum);
}

double peak_frequency(const Periodogram& of, double low_hz) {
  if (of.power.size() == 0) return kNaN;
  const auto& power = of.power;
  const auto first = std::max<std::int64_t>(1, std::llround(std::ceil(low_hz / of.step_hz)));
  if (first + 1 >= power.size()) return kNaN;
  Eigen::Index at = 0;
  power.segment(first, power.size() - 1 - first).maxCoeff(&at);
  const std::int64_t k = first + at;
  if (!(power[k - 1] > 0.0 && power[k] > 0.0 && power[k + 1] > 0.0)) return kNaN;
  const double before = std::log(power[k - 1]), here = std::log(power[k]), after = std::log(power[k + 1]);
  const double second_difference = before - 2.0 * here + after;
  const double shift =
      second_difference < 0.0 ? std::clamp(0.5 * (before - after) / second_difference, -0.5, 0.5) : 0.0;
  return (static_cast<double>(k) + shift) * of.step_hz;
}

}  // namespace kinemark::analysis

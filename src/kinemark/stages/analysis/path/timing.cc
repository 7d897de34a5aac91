// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/timing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "kinemark/math/fourier.h"
#include "kinemark/math/golden_section.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/path/spectrum.h"

namespace kinemark::analysis {
namespace {

constexpr double kLeastCycle = 0.4;  // of the median; what is shorter is noise about a crossing
constexpr int kHalvings = 40;        // of the way between two samples
constexpr double kNarrow = 1e-7;     // share of it: a peak is flat, and no better known
constexpr int kTrendPasses = 3;      // each takes the trend of the cycles that the one before found

// n values from -(n-1)/2 to (n-1)/2.
Eigen::VectorXd centred_index(std::int64_t n) {
  return Eigen::VectorXd::LinSpaced(n, -0.5 * static_cast<double>(n - 1), 0.5 * static_cast<double>(n - 1));
}

// Hann's window, kept for the next path of as many samples, as refits are.
struct Window {
  Eigen::VectorXd values;
  double squared = 0.0;
};
const Window& hann_window(std::int64_t n) {
  thread_local Window last;
  if (last.values.size() != n) {
    last.values = (0.5 - 0.5 * ((centred_index(n).array() + 0.5 * static_cast<double>(n - 1)) *
                                (2.0 * M_PI / static_cast<double>(n - 1)))
                                   .cos())
                      .matrix();
    last.squared = last.values.squaredNorm();
  }
  return last;
}

// Squared speed a share of the way from one sample to its neighbour, before or behind it.
double squared_between(const PathSamples& path, std::int64_t from, std::int64_t to, double share) {
  const double t = share, step_s = static_cast<double>(to - from) / path.rate_hz;
  const double toward = t * t * (3.0 - 2.0 * t);
  const Eigen::RowVectorXd v = (1.0 - toward) * path.v.row(from) + toward * path.v.row(to) +
                               step_s * t * (1.0 - t) * ((1.0 - t) * path.a.row(from) - t * path.a.row(to));
  return v.squaredNorm();
}

}  // namespace

Eigen::VectorXd speed_of(const PathSamples& path) {
  Eigen::ArrayXd squared = Eigen::ArrayXd::Zero(path.v.rows());
  for (Eigen::Index k = 0; k < path.v.cols(); ++k) squared += path.v.col(k).array().square();
  return squared.sqrt().matrix();
}

SpeedPeak speed_peak(const PathSamples& path, const Eigen::VectorXd& speed) {
  if (speed.size() == 0) return {};
  Eigen::Index at = 0;
  const double largest = speed.maxCoeff(&at);
  SpeedPeak out{.time_s = static_cast<double>(at) / path.rate_hz, .speed = largest};
  const Eigen::Index to = path.v.row(at).dot(path.a.row(at)) > 0.0 ? at + 1 : at - 1;
  if (to < 0 || to >= speed.size()) return out;
  const auto found = math::golden_section([&](double share) { return -squared_between(path, at, to, share); },
                                          0.0, 1.0, {.width = kNarrow});
  if (const double speed_there = std::sqrt(-found.value); speed_there > largest) {
    out.time_s += found.at * static_cast<double>(to - at) / path.rate_hz;
    out.speed = speed_there;
  }
  return out;
}

double crossing_s(const PathSamples& path, std::int64_t below, std::int64_t above, double level) {
  double low = 0.0, high = 1.0;  // shares of the way from below to above
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (squared_between(path, below, above, middle) > level * level ? high : low) = middle;
  }
  return (static_cast<double>(below) + 0.5 * (low + high) * static_cast<double>(above - below)) /
         path.rate_hz;
}

std::vector<MovementWindow> movements_of(const PathSamples& path, const Eigen::VectorXd& speed) {
  std::vector<MovementWindow> out;
  const double rate_hz = path.rate_hz;
  const auto hold = std::max<std::int64_t>(2, std::llround(kMovingHold_s * rate_hz));
  const std::int64_t n = speed.size();
  if (n == 0) return out;
  const double level = kMovingShare * speed_peak(path, speed).speed;
  std::int64_t first = -1, last = -1;  // samples of the movement that is open
  const auto close = [&] {
    if (first < 0) return;
    out.push_back({.onset_s = first > 0 ? crossing_s(path, first - 1, first, level) : kNaN,
                   .end_s = last + 1 < n ? crossing_s(path, last + 1, last, level) : kNaN});
    first = -1;
  };
  std::int64_t above = 0, below = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    const bool moves = speed[i] > level;
    above = moves ? above + 1 : 0;
    below = moves ? 0 : below + 1;
    if (above >= hold) {
      if (first < 0) first = i - above + 1;
      last = i;
    }
    if (below >= hold) close();
  }
  close();
  return out;
}

MovementWindow movement_window(const PathSamples& path, const Eigen::VectorXd& speed) {
  const auto movements = movements_of(path, speed);
  if (movements.empty()) return {};
  return {.onset_s = movements.front().onset_s, .end_s = movements.back().end_s};
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

PathMatrix without_trend(const PathMatrix& x) {
  const Eigen::VectorXd t = centred_index(x.rows());
  PathMatrix out = x.rowwise() - x.colwise().mean().eval();
  if (x.rows() > 1) out -= t * (t.transpose() * out).eval() / t.squaredNorm();
  return out;
}

Eigen::Vector3d detrended_axis(const PathMatrix& x) {
  const PathMatrix level = without_trend(x);
  const Eigen::Matrix3d spread = level.transpose() * level;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

namespace {

/// Upward crossings of zero, in samples.
std::vector<double> upward_crossings(const Eigen::VectorXd& z) {
  std::vector<double> out;
  for (std::int64_t i = 0; i + 1 < z.size(); ++i)
    if (z[i] < 0.0 && z[i + 1] >= 0.0) out.push_back(static_cast<double>(i) - z[i] / (z[i + 1] - z[i]));
  return out;
}

/// Take the straight line through the means of whole cycles off. That of least squares, as of
/// without_trend(), is no line of zero for a cosine that begins and ends anywhere, and moves its crossings
/// apart.
/// @param starts  of the cycles, in samples
/// @return        false, with z as it was, where fewer than two cycles are whole
bool take_cycle_trend(std::span<const double> starts, Eigen::VectorXd& z) {
  std::vector<double> lengths;
  for (std::size_t i = 1; i < starts.size(); ++i) lengths.push_back(starts[i] - starts[i - 1]);
  if (lengths.size() < 2) return false;
  const double least = kLeastCycle * math::median(lengths);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(z.size());  // by trapezoids, up to each sample
  for (Eigen::Index i = 1; i < z.size(); ++i) sum[i] = sum[i - 1] + 0.5 * (z[i - 1] + z[i]);
  const auto up_to = [&](double at) {
    const auto i = std::min(static_cast<Eigen::Index>(at), z.size() - 2);
    const double share = at - static_cast<double>(i);
    return sum[i] + share * (z[i] + 0.5 * share * (z[i + 1] - z[i]));
  };
  std::vector<Eigen::Vector2d> means;  // middle of a cycle in samples, mean of z in it
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] > least)
      means.emplace_back(0.5 * (starts[i] + starts[i + 1]),
                         (up_to(starts[i + 1]) - up_to(starts[i])) / lengths[i]);
  if (means.size() < 2) return false;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const auto& one : means) centre += one / static_cast<double>(means.size());
  double with_time = 0.0, spread = 0.0;
  for (const auto& one : means) {
    with_time += (one[0] - centre[0]) * (one[1] - centre[1]);
    spread += (one[0] - centre[0]) * (one[0] - centre[0]);
  }
  const double slope = with_time / spread;
  for (Eigen::Index i = 0; i < z.size(); ++i)
    z[i] -= centre[1] + slope * (static_cast<double>(i) - centre[0]);
  return true;
}

}  // namespace

std::vector<double> cycle_starts(const PathMatrix& x, const Eigen::Vector3d& axis, double rate_hz,
                                 CycleTrend trend) {
  const PathMatrix along = x * axis;
  Eigen::VectorXd z = without_trend(along);
  auto starts = upward_crossings(z);
  const int passes = trend == CycleTrend::of_whole_cycles ? kTrendPasses : 0;
  for (int pass = 0; pass < passes && take_cycle_trend(starts, z); ++pass) starts = upward_crossings(z);
  for (double& start : starts) start /= rate_hz;
  return starts;
}

Cycles cycles_along(const PathMatrix& x, const Eigen::Vector3d& axis, double rate_hz) {
  const auto crossings = cycle_starts(x, axis, rate_hz, CycleTrend::of_whole_cycles);
  std::vector<double> lengths;
  for (std::size_t i = 1; i < crossings.size(); ++i) lengths.push_back(crossings[i] - crossings[i - 1]);
  if (lengths.size() > 1) {
    const double least = kLeastCycle * math::median(lengths);
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

Periodogram periodogram_of(const PathMatrix& x, double rate_hz, double highest_hz) {
  const std::int64_t n = x.rows();
  if (n < 8) return {};
  const Window& window = hann_window(n);
  const std::int64_t length = math::FourierTransform::good_length(n);
  PathMatrix level = without_trend(x);
  level.array().colwise() *= window.values.array();
  const double step_hz = rate_hz / static_cast<double>(length);
  const std::int64_t half = length / 2;
  const auto highest =
      static_cast<std::int64_t>(std::min(std::ceil(highest_hz / step_hz) + 1.0, static_cast<double>(half)));
  Periodogram out{.step_hz = step_hz,
                  .per_mean_square = 2.0 / (window.squared * static_cast<double>(length)),
                  .power = low_powers(level, length, highest)};
  if (highest < length / 2) {
    // All frequencies together have the samples' squares (Parseval); each but the first is there twice.
    const double all = level.squaredNorm() * static_cast<double>(length);
    out.most_above =
        std::max(0.0, all - out.power[0] - 2.0 * out.power.segment(1, highest - 1).sum()) + 1e-9 * all;
  }
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
  if (power[k] <= of.most_above) return kNaN;
  if (!(power[k - 1] > 0.0 && power[k] > 0.0 && power[k + 1] > 0.0)) return kNaN;
  const double before = std::log(power[k - 1]), here = std::log(power[k]), after = std::log(power[k + 1]);
  const double second_difference = before - 2.0 * here + after;
  const double shift =
      second_difference < 0.0 ? std::clamp(0.5 * (before - after) / second_difference, -0.5, 0.5) : 0.0;
  return (static_cast<double>(k) + shift) * of.step_hz;
}

}  // namespace kinemark::analysis

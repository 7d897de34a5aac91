// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::skeleton::internal {
namespace {

using math::quantile;

constexpr double kMostNats = 50.0;  ///< evidence saturates, so that one pair cannot outweigh all others
constexpr int kGrid = 80;           ///< grid of sizes of motion
constexpr double kSlow = 0.3;       ///< distances that correlate so far vary by more than noise
constexpr double kUneven = 1.5;     ///< and so do those whose spread differs so much between markers
constexpr double kFinest_m = 5e-5;  ///< smallest motion of the grid
constexpr double kOneFifth = 0.2, kFourFifths = 0.8;

/// log of a mean of exp(terms) under weights.
double log_mean(const Eigen::ArrayXd& terms, const Eigen::ArrayXd& weights) {
  const double largest = terms.maxCoeff();
  return largest + std::log((weights * (terms - largest).exp()).sum() + 1e-300);
}

}  // namespace

std::vector<std::int64_t> draw_evenly(std::int64_t frames, std::int64_t n) {
  n = std::min(frames, n);
  std::vector<std::int64_t> out;
  for (std::int64_t i = 0; i < n; ++i) out.push_back(i * frames / n);
  return out;
}

data::Trajectories cut(const data::Trajectories& t, const std::vector<std::int64_t>& frames,
                       const Array<std::uint8_t>& mask) {
  auto out = data::Trajectories::all_missing(
      t.names, {.rate_hz = t.time.rate_hz, .t0_s = 0.0, .frames = static_cast<std::int64_t>(frames.size())});
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(frames[i], m) || (!mask.empty() && !mask[t.index(frames[i], m)])) continue;
      out.x(static_cast<std::int64_t>(i), m) = t.x(frames[i], m);
      out.state[out.index(static_cast<std::int64_t>(i), m)] = data::SampleState::measured;
    }
  return out;
}

PairSpread measure_pairs(const Samples& samples, const std::vector<int>& markers,
                         const std::vector<std::int64_t>& frames, std::int64_t least_frames) {
  const auto M = static_cast<Eigen::Index>(markers.size());
  PairSpread pairs;
  pairs.variance = pairs.correlation = Eigen::MatrixXd::Constant(M, M, kNaN);
  pairs.frames = Eigen::MatrixXd::Zero(M, M);
  std::vector<double> d;
  for (Eigen::Index i = 0; i < M; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const int a = markers[static_cast<std::size_t>(i)], b = markers[static_cast<std::size_t>(j)];
      d.clear();
      for (const std::int64_t f : frames)
        if (samples.seen(f, a) && samples.seen(f, b)) d.push_back((samples.x(f, a) - samples.x(f, b)).norm());
      pairs.frames(i, j) = pairs.frames(j, i) = static_cast<double>(d.size());
      if (static_cast<std::int64_t>(d.size()) < least_frames) continue;
      const double mean = std::reduce(d.begin(), d.end()) / static_cast<double>(d.size());
      double squares = 0.0, products = 0.0;
      for (std::size_t k = 0; k < d.size(); ++k) {
        squares += (d[k] - mean) * (d[k] - mean);
        if (k > 0) products += (d[k] - mean) * (d[k - 1] - mean);
      }
      pairs.variance(i, j) = pairs.variance(j, i) = squares / static_cast<double>(d.size() - 1);
      pairs.correlation(i, j) = pairs.correlation(j, i) = squares > 0.0 ? products / squares : 0.0;
    }
  return pairs;
}

SameSegment describe_same_segment(const PairSpread& pairs, double noise_sd_m, double least_soft_m) {
  std::vector<double> two_steadiest, second, slow, counts;
  const auto M = pairs.variance.rows();
  for (Eigen::Index i = 0; i < M; ++i) {
    std::vector<std::pair<double, Eigen::Index>> seen;
    for (Eigen::Index j = 0; j < M; ++j)
      if (j != i && !std::isnan(pairs.variance(i, j))) seen.emplace_back(pairs.variance(i, j), j);
    if (seen.empty()) continue;
    std::ranges::sort(seen);
    two_steadiest.push_back(seen[0].first);
    slow.push_back(pairs.correlation(i, seen[0].second));
    counts.push_back(pairs.frames(i, seen[0].second));
    second.push_back(seen[std::min<std::size_t>(1, seen.size() - 1)].first);
    two_steadiest.push_back(second.back());
  }
  SameSegment same;
  if (second.empty()) return same;
  const double correlation = std::clamp(quantile(slow, 0.5), 0.0, 0.999);
  same.independent = (1.0 - correlation) / (1.0 + correlation);
  same.noise_variance = noise_sd_m > 0.0 ? noise_sd_m * noise_sd_m : 0.5 * quantile(two_steadiest, 0.5);
  // Chi-square with so many degrees of freedom spreads by chance alone.
  const double freedom = std::max(1.0, same.independent * quantile(counts, 0.5) - 1.0);
  const double chance = std::exp(4.0 * std::sqrt(2.0 / freedom));
  const double uneven = quantile(second, kFourFifths) / std::max(quantile(second, kOneFifth), 1e-30);
  if (correlation > kSlow || uneven > std::max(kUneven, chance)) {
    same.soft_sd_m = std::max(least_soft_m, std::sqrt(quantile(second, 0.5)));
    if (!(noise_sd_m > 0.0)) same.noise_variance *= 0.3;  // the rest of what was seen is soft tissue
  }
  return same;
}

Eigen::MatrixXd log_odds(const PairSpread& pairs, const SameSegment& same, const OddsOptions& options) {
  const auto M = pairs.variance.rows();
  const double noise = 2.0 * same.noise_variance;
  // Motion smaller than the noise would only model an error of the noise estimate.
  const double least = std::max({options.least_motion_m, std::sqrt(noise), same.soft_sd_m});
  const double most = std::max(options.most_motion_m, 2.0 * least);
  const double finest = same.soft_sd_m > 0.0 ? kFinest_m : least;
  const Eigen::ArrayXd sizes = Eigen::ArrayXd::LinSpaced(kGrid, std::log(finest), std::log(most)).exp();
  Eigen::ArrayXd moving = (sizes >= 0.999 * least).cast<double>();
  moving /= moving.sum();
  // Soft tissue: half normal; the grid is even in the logarithm.
  Eigen::ArrayXd soft = Eigen::ArrayXd::Zero(kGrid);
  if (same.soft_sd_m > 0.0) {
    soft = sizes * (-0.5 * (sizes / same.soft_sd_m).square()).exp();
    soft /= soft.sum();
  }
  // Lower bound without noise and soft tissue: rounding of files.
  const double floor = 1e-8;
  Eigen::MatrixXd odds = Eigen::MatrixXd::Zero(M, M);
  for (Eigen::Index i = 0; i < M; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double v = pairs.variance(i, j);
      if (std::isnan(v)) continue;
      const double half = 0.5 * std::max(1.0, same.independent * pairs.frames(i, j) - 1.0);
      const Eigen::ArrayXd expected = noise + floor + sizes.square();
      const Eigen::ArrayXd terms = -half * (expected.log() + v / expected);
      const double still = noise + floor;
      const double together =
          same.soft_sd_m > 0.0 ? log_mean(terms, soft) : -half * (std::log(still) + v / still);
      odds(i, j) = odds(j, i) = std::clamp(together - log_mean(terms, moving), -kMostNats, kMostNats);
    }
  return odds;
}

double noise_within(const PairSpread& pairs, const std::vector<int>& segment) {
  std::vector<double> within;
  for (std::size_t i = 0; i < segment.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double v = pairs.variance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (segment[i] == segment[j] && !std::isnan(v)) within.push_back(v);
    }
  return within.empty() ? kNaN : 0.5 * quantile(within, 0.5);
}

double mean_odds(const Eigen::MatrixXd& odds, const PairSpread& pairs, const std::vector<int>& segment,
                 std::size_t i, int s) {
  double sum = 0.0;
  int n = 0;
  for (std::size_t j = 0; j < segment.size(); ++j) {
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    if (j == i || segment[j] != s || std::isnan(pairs.variance(a, b))) continue;
    sum += odds(a, b);
    ++n;
  }
  return n > 0 ? sum / n : kNaN;
}

double least_odds(const Eigen::MatrixXd& odds, const PairSpread& pairs, const std::vector<int>& segment,
                  std::size_t i) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < segment.size(); ++j) {
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    if (j != i && segment[j] == segment[i] && !std::isnan(pairs.variance(a, b)))
      least = std::min(least, odds(a, b));
  }
  return std::isinf(least) ? 0.0 : least;
}

std::vector<int> cluster(const Eigen::MatrixXd& odds, const PairSpread& pairs) {
  const auto M = static_cast<std::size_t>(odds.rows());
  std::vector<int> segment(M);
  std::iota(segment.begin(), segment.end(), 0);
  // Sums and counts between clusters, kept up to date as clusters merge.
  Eigen::MatrixXd sums = odds, counts = Eigen::MatrixXd::Zero(odds.rows(), odds.cols());
  for (Eigen::Index i = 0; i < odds.rows(); ++i)
    for (Eigen::Index j = 0; j < odds.rows(); ++j) counts(i, j) = i != j && !std::isnan(pairs.variance(i, j));
  std::vector<Eigen::Index> alive(M);
  std::iota(alive.begin(), alive.end(), 0);
  while (alive.size() > 1) {
    double best = 0.0;
    std::size_t keep = 0, drop = 0;
    for (std::size_t x = 0; x < alive.size(); ++x)
      for (std::size_t y = 0; y < x; ++y) {
        const double link = sums(alive[x], alive[y]) / std::max(1.0, counts(alive[x], alive[y]));
        if (link <= best) continue;
        best = link;
        keep = y;
        drop = x;
      }
    if (best <= 0.0) break;
    const Eigen::Index to = alive[keep], from = alive[drop];
    for (auto* m : {&sums, &counts}) {
      m->row(to) += m->row(from).eval();
      m->col(to) += m->col(from).eval();
    }
    for (int& s : segment)
      if (s == static_cast<int>(from)) s = static_cast<int>(to);
    alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(drop));
  }
  // A marker near a joint may have been merged with the wrong segment early.
  for (std::size_t round = 0; round < M; ++round) {
    Eigen::MatrixXd to_segment = Eigen::MatrixXd::Zero(odds.rows(), odds.rows()), seen = to_segment;
    for (Eigen::Index i = 0; i < odds.rows(); ++i)
      for (Eigen::Index j = 0; j < odds.rows(); ++j) {
        if (i == j || std::isnan(pairs.variance(i, j))) continue;
        to_segment(i, segment[static_cast<std::size_t>(j)]) += odds(i, j);
        seen(i, segment[static_cast<std::size_t>(j)]) += 1.0;
      }
    double gain = 0.0;
    Eigen::Index who = 0, where = 0;
    for (Eigen::Index i = 0; i < odds.rows(); ++i) {
      const int own = segment[static_cast<std::size_t>(i)];
      if (seen(i, own) == 0.0) continue;
      for (const Eigen::Index s : alive) {
        if (s == own || seen(i, s) == 0.0) continue;
        const double more = to_segment(i, s) / seen(i, s) - to_segment(i, own) / seen(i, own);
        if (more <= gain) continue;
        gain = more;
        who = i;
        where = s;
      }
    }
    if (gain <= 0.0) break;
    segment[static_cast<std::size_t>(who)] = static_cast<int>(where);
  }
  // Number by first marker.
  std::vector<int> number(M, -1);
  int next = 0;
  for (int& s : segment) {
    int& n = number[static_cast<std::size_t>(s)];
    if (n < 0) n = next++;
    s = n;
  }
  return segment;
}

}  // namespace kinemark::skeleton::internal

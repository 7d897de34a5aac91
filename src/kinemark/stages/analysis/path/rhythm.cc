// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/rhythm.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

// Sums of v[i] . v[i + lag] over i, for lags from 0 to `most`.
std::vector<double> products_by_lag(const SeriesMatrix& v, std::int64_t most) {
  std::int64_t length = 2;
  while (length < v.rows() + most + 1) length *= 2;
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> power(at(length)), spectrum;
  for (Eigen::Index axis = 0; axis < v.cols(); ++axis) {
    std::vector<std::complex<double>> padded(at(length));
    for (Eigen::Index i = 0; i < v.rows(); ++i) padded[at(i)] = v(i, axis);
    transform.fwd(spectrum, padded);
    for (std::size_t k = 0; k < power.size(); ++k) power[k] += std::norm(spectrum[k]);
  }
  transform.inv(spectrum, power);
  std::vector<double> out(at(most + 1));
  for (std::size_t lag = 0; lag < out.size(); ++lag) out[lag] = spectrum[lag].real();
  return out;
}

// A row of crossings, each a period behind the one before.
struct Row {
  std::vector<std::size_t> members;
  double squares = 0.0;  // of what its cycles differ from the period
};

Row row_from(std::size_t first, std::span<const double> crossings, double period_s) {
  Row out{.members = {first}};
  for (std::size_t last = first;;) {
    std::size_t best = last;
    double least = kPeriodSlack * period_s;
    for (std::size_t next = last + 1; next < crossings.size(); ++next) {
      const double off = std::abs(crossings[next] - crossings[last] - period_s);
      if (off < least) best = next, least = off;
      if (crossings[next] - crossings[last] > (1.0 + kPeriodSlack) * period_s) break;
    }
    if (best == last) return out;
    out.members.push_back(best);
    out.squares += least * least;
    last = best;
  }
}

}  // namespace

Period period_of(const SeriesMatrix& v, double rate_hz) {
  const std::int64_t n = v.rows(), most = n / 2;
  if (n < 8) return {};
  const Eigen::RowVector3d mean = v.colwise().mean();
  const SeriesMatrix level = v.rowwise() - mean;
  // What is left of a straight way at even speed is rounding.
  if (level.squaredNorm() <= 1e-20 * static_cast<double>(n) * mean.squaredNorm()) return {};
  const auto products = products_by_lag(level, most);
  std::vector<double> squares(at(n + 1), 0.0);  // of the samples before each
  for (std::int64_t i = 0; i < n; ++i) squares[at(i + 1)] = squares[at(i)] + level.row(i).squaredNorm();
  std::vector<double> likeness(products.size(), 0.0);
  for (std::int64_t lag = 0; lag <= most; ++lag) {
    const double both = squares[at(n - lag)] * (squares[at(n)] - squares[at(lag)]);
    if (both > 0.0) likeness[at(lag)] = products[at(lag)] / std::sqrt(both);
  }
  const auto unlike = std::ranges::find_if(likeness, [](double r) { return r <= 0.0; });
  if (unlike == likeness.end()) return {};
  const double enough = 0.9 * *std::max_element(unlike, likeness.end());
  if (!(enough > 0.0)) return {};
  for (auto lag = unlike - likeness.begin(); lag < most; ++lag) {
    const double here = likeness[at(lag)], before = likeness[at(lag - 1)], after = likeness[at(lag + 1)];
    if (here < enough || here < before || here < after) continue;
    const double second_difference = before - 2.0 * here + after;
    const double shift =
        second_difference < 0.0 ? std::clamp(0.5 * (before - after) / second_difference, -0.5, 0.5) : 0.0;
    return {.s = (static_cast<double>(lag) + shift) / rate_hz, .likeness = here};
  }
  return {};
}

double likeness_after(const SeriesMatrix& v, double rate_hz, double lag_s) {
  const std::int64_t n = v.rows();
  const double lag = lag_s * rate_hz;
  if (!(lag > 0.0 && 1.1 * lag + 1.0 < static_cast<double>(n))) return 0.0;
  const std::int64_t first = std::max<std::int64_t>(1, std::llround(0.9 * lag)),
                     last = std::llround(1.1 * lag);
  const Eigen::RowVector3d mean = v.colwise().mean();
  const auto step = 1 + n * (last - first + 1) / 20'000'000;
  double best = 0.0;
  for (auto k = first; k <= last; ++k) {
    double product = 0.0, before = 0.0, after = 0.0;
    for (std::int64_t i = 0; i + k < n; i += step) {
      const Eigen::RowVector3d a = v.row(i) - mean, b = v.row(i + k) - mean;
      product += a.dot(b), before += a.squaredNorm(), after += b.squaredNorm();
    }
    if (before > 0.0 && after > 0.0) best = std::max(best, product / std::sqrt(before * after));
  }
  return best;
}

std::vector<CycleEnds> cycles_among(std::span<const double> crossings, double period_s) {
  std::vector<CycleEnds> out;
  for (std::size_t from = 0; from < crossings.size();) {
    Row best;
    for (std::size_t first = from; first < crossings.size() && crossings[first] < crossings[from] + period_s;
         ++first) {
      auto row = row_from(first, crossings, period_s);
      if (row.members.size() > best.members.size() ||
          (row.members.size() == best.members.size() && row.squares < best.squares))
        best = std::move(row);
    }
    for (std::size_t k = 0; k + 1 < best.members.size(); ++k)
      out.emplace_back(best.members[k], best.members[k + 1]);
    from = best.members.size() > 1 ? best.members.back() + 1 : from + 1;
  }
  return out;
}

std::vector<std::size_t> kinds_of(std::span<const Eigen::Vector3d> ways) {
  double longest = 0.0;
  for (const auto& way : ways) longest = std::max(longest, way.norm());
  std::vector<Eigen::Vector3d> examples;
  std::vector<std::size_t> out;
  for (const auto& way : ways) {
    const bool returns = way.norm() < 0.25 * longest;
    const auto like = [&](const Eigen::Vector3d& example) {
      if (returns || example.norm() < 0.25 * longest) return returns && example.norm() < 0.25 * longest;
      return (way - example).norm() < 0.5 * std::max(way.norm(), example.norm());
    };
    const auto found = std::ranges::find_if(examples, like);
    out.push_back(static_cast<std::size_t>(found - examples.begin()));
    if (found == examples.end()) examples.push_back(way);
  }
  return out;
}

}  // namespace kinemark::analysis

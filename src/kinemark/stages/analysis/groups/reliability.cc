// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/reliability.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <numbers>
#include <span>

namespace kinemark::analysis {
namespace {

/// Mean squares of the two-way table of n subjects and k sessions.
struct MeanSquares {
  double n = 0.0, k = 0.0, mean = 0.0, subjects = 0.0, sessions = 0.0, error = 0.0;
};

MeanSquares mean_squares(std::span<const double> rows, std::size_t k) {
  const std::size_t n = rows.size() / k;
  MeanSquares ms{.n = static_cast<double>(n), .k = static_cast<double>(k)};
  for (const double value : rows) ms.mean += value / static_cast<double>(rows.size());
  std::vector<double> row(n, 0.0), column(k, 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    row[i / k] += (rows[i] - ms.mean) / ms.k;
    column[i % k] += (rows[i] - ms.mean) / ms.n;
  }
  for (const double r : row) ms.subjects += ms.k * r * r / (ms.n - 1.0);
  for (const double c : column) ms.sessions += ms.n * c * c / (ms.k - 1.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double rest = rows[i] - ms.mean - row[i / k] - column[i % k];
    ms.error += rest * rest / ((ms.n - 1.0) * (ms.k - 1.0));
  }
  return ms;
}

/// The value that F exceeds with the probability `above`.
double f_above(double above, double dof1, double dof2) {
  return boost::math::quantile(boost::math::complement(boost::math::fisher_f(dof1, dof2), above));
}

Bounded consistency_of(const MeanSquares& ms, double above) {
  const double dof = ms.n - 1.0, error_dof = dof * (ms.k - 1.0);
  const double f = ms.subjects / ms.error;
  const auto icc = [&](double ratio) { return (ratio - 1.0) / (ratio + ms.k - 1.0); };
  return {icc(f), icc(f / f_above(above, dof, error_dof)), icc(f * f_above(above, error_dof, dof))};
}

Bounded agreement_of(const MeanSquares& ms, double above) {
  const double n = ms.n, k = ms.k;
  const double icc =
      (ms.subjects - ms.error) / (ms.subjects + (k - 1.0) * ms.error + k * (ms.sessions - ms.error) / n);
  const double a = k * icc * ms.sessions / ms.error, b = n * (1.0 + (k - 1.0) * icc) - k * icc;
  const double dof = (k - 1.0) * (n - 1.0) * (a + b) * (a + b) / ((n - 1.0) * a * a + b * b);
  const double rest = k * ms.sessions + (k * n - k - n) * ms.error;
  const double down = f_above(above, n - 1.0, dof), up = f_above(above, dof, n - 1.0);
  return {icc, n * (ms.subjects - down * ms.error) / (down * rest + n * ms.subjects),
          n * (up * ms.subjects - ms.error) / (rest + n * up * ms.subjects)};
}

Bounded sem_of(const MeanSquares& ms, double above) {
  const double dof = (ms.n - 1.0) * (ms.k - 1.0);
  const boost::math::chi_squared chi2(dof);
  const auto end = [&](double quantile) { return std::sqrt(ms.error * dof / quantile); };
  return {std::sqrt(ms.error), end(boost::math::quantile(boost::math::complement(chi2, above))),
          end(boost::math::quantile(chi2, above))};
}

}  // namespace

Result<Reliability> reliability(const RepeatedMeasure& measure, double level) {
  if (!(level > 0.0 && level < 1.0))
    return fail(Code::usage,
                fmt::format("the level of an interval is {}; need one above 0 and below 1", level));
  const auto k = static_cast<std::size_t>(std::max<std::int64_t>(measure.sessions, 0));
  const std::size_t need = static_cast<std::size_t>(std::max<std::int64_t>(measure.subjects, 0)) * k;
  if (measure.values.size() != need || (!measure.noise_sd.empty() && measure.noise_sd.size() != need))
    return fail(Code::bad_input, fmt::format("{} subjects in {} sessions have {} values and {} deviations; "
                                             "need {}, and as many or no deviations",
                                             measure.subjects, measure.sessions, measure.values.size(),
                                             measure.noise_sd.size(), need));
  Reliability result{.level = level};
  std::vector<double> rows;
  double noise = 0.0;
  for (std::size_t at = 0; at < need; at += k) {
    const std::span<const double> row(measure.values.data() + at, k);
    if (std::ranges::any_of(row, [](double value) { return !std::isfinite(value); })) {
      ++result.left_out;
      continue;
    }
    rows.insert(rows.end(), row.begin(), row.end());
    if (!measure.noise_sd.empty())
      for (std::size_t s = at; s < at + k; ++s) noise += measure.noise_sd[s] * measure.noise_sd[s];
  }
  if (k < 2 || rows.size() < 2 * k)
    return fail(
        Code::bad_input,
        fmt::format(
            "{} subjects have a value in each of {} sessions; need at least 2 subjects and 2 sessions",
            k == 0 ? 0 : rows.size() / k, k));
  const auto ms = mean_squares(rows, k);
  const double above = (1.0 - level) / 2.0;
  result.subjects = static_cast<std::int64_t>(ms.n);
  result.mean = ms.mean;
  if (ms.error > 0.0) {
    result.agreement = agreement_of(ms, above);
    result.consistency = consistency_of(ms, above);
  } else {
    result.consistency = {1.0, 1.0, 1.0};
    if (!(ms.sessions > 0.0)) result.agreement = result.consistency;
  }
  result.sem = sem_of(ms, above);
  result.sem_agreement = std::sqrt(ms.error + std::max(0.0, ms.sessions - ms.error) / ms.n);
  result.mdc = 1.959963984540054 * std::numbers::sqrt2 * result.sem.value;
  if (measure.noise_sd.empty()) return result;
  const double noise_variance = noise / static_cast<double>(rows.size());
  const double movement = std::max(0.0, ms.error - noise_variance);
  const double between = std::max(0.0, (ms.subjects - ms.error) / ms.k);
  result.noise = std::sqrt(noise_variance);
  result.sem_movement = std::sqrt(movement);
  if (between + movement > 0.0) result.consistency_movement = between / (between + movement);
  return result;
}

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/mean_band.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

double factor_of(double dof, double arc_length, double points, double level) {
  const boost::math::students_t t(dof);
  const auto error = [&](double c) {
    const double crossings =
        arc_length / (2.0 * std::numbers::pi) * std::pow(1.0 + c * c / dof, -(dof - 1.0) / 2.0);
    return 2.0 * (boost::math::cdf(boost::math::complement(t, c)) + crossings);
  };
  const double bonferroni = boost::math::quantile(boost::math::complement(t, (1.0 - level) / (2.0 * points)));
  if (error(bonferroni) >= 1.0 - level) return bonferroni;
  double low = 0.0, high = bonferroni;
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (error(middle) > 1.0 - level ? low : high) = middle;
  }
  return high;
}

}  // namespace

double MeanBand::of_mean(std::size_t point) const {
  return factor * sd[point] / std::sqrt(static_cast<double>(curves));
}

double MeanBand::of_one(std::size_t point) const {
  return factor * sd[point] * std::sqrt(1.0 + 1.0 / static_cast<double>(curves));
}

Result<MeanBand> mean_band(const data::CycleCurves& curves, double level) {
  if (!(level > 0.0 && level < 1.0))
    return fail(Code::usage, fmt::format("the level of a band is {}; need one above 0 and below 1", level));
  if (auto valid = curves.validate(); !valid) return std::unexpected(valid.error());
  if (curves.count() < 3)
    return fail(Code::bad_input,
                fmt::format("a band of {} curves is asked for; need at least 3", curves.count()));
  const auto n = static_cast<double>(curves.count());
  const auto points = static_cast<std::size_t>(curves.points);
  MeanBand band{.curves = curves.count(),
                .level = level,
                .mean = std::vector(points, 0.0),
                .sd = std::vector(points, 0.0)};
  for (std::size_t p = 0; p < points; ++p) {
    const auto point = static_cast<std::int64_t>(p);
    for (std::int64_t i = 0; i < curves.count(); ++i) band.mean[p] += curves(i, point) / n;
    for (std::int64_t i = 0; i < curves.count(); ++i)
      band.sd[p] += (curves(i, point) - band.mean[p]) * (curves(i, point) - band.mean[p]) / (n - 1.0);
    band.sd[p] = std::sqrt(band.sd[p]);
    band.not_tested += std::isnan(band.mean[p]);
    if (p == 0 || !(band.sd[p] > 0.0) || !(band.sd[p - 1] > 0.0)) continue;
    double distance = 0.0;  // between unit vectors of residuals, squared
    for (std::int64_t i = 0; i < curves.count(); ++i) {
      const double step = (curves(i, point) - band.mean[p]) / band.sd[p] -
                          (curves(i, point - 1) - band.mean[p - 1]) / band.sd[p - 1];
      distance += step * step / (n - 1.0);
    }
    band.arc_length += 2.0 * std::asin(std::min(1.0, std::sqrt(distance) / 2.0));
  }
  band.factor = factor_of(n - 1.0, band.arc_length, static_cast<double>(curves.points), level);
  return band;
}

}  // namespace kinemark::analysis

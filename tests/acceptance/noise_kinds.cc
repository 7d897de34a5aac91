// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/noise_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/digital_filter.h"

namespace kinemark::acceptance {
namespace {

using math::SeriesMatrix;

double student(Random& random) {  // three degrees of freedom, variance 1
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) squares += std::pow(random.gaussian(), 2);
  return random.gaussian() / std::sqrt(squares);
}

void run_filter(const std::string& colour, double hz, double rate, SeriesMatrix& x) {
  if (colour == "butterworth") {
    const auto sections = math::butterworth_lowpass(2, math::two_pass_cutoff(2, hz / rate));
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      std::vector<double> column(x.col(k).begin(), x.col(k).end());
      math::filter_both_ways(
          sections, static_cast<int>(std::min<double>(rate, static_cast<double>(x.rows() - 2))), column);
      for (std::int64_t i = 0; i < x.rows(); ++i) x(i, k) = column[static_cast<std::size_t>(i)];
    }
    return;
  }
  math::DifferenceSmoother smoother(std::vector<bool>(static_cast<std::size_t>(x.rows()), true),
                                    colour == "spline" ? 3 : 5);
  if (!smoother.factor(hz / rate)) std::abort();
  smoother.smooth(x);
}

}  // namespace

bool is_filtered(const std::string& colour) {
  return colour == "butterworth" || colour == "spline" || colour == "smoother";
}

double draw_cutoff(double rate_hz, Random& random) {
  return std::min(random.uniform(6.0, 20.0), 0.35 * rate_hz);
}

void low_pass(const std::string& colour, double hz, double rate_hz, SeriesMatrix& x) {
  run_filter(colour, hz, rate_hz, x);
  for (auto& value : x.reshaped()) value = static_cast<float>(value);
}

double three_db_of(const std::string& colour, double hz, double rate_hz, std::int64_t frames) {
  const std::int64_t n = std::max<std::int64_t>(frames, 800), middle = n / 2;
  double low = 0.5, high = 0.45 * rate_hz;
  for (int i = 0; i < 24; ++i) {
    const double at_hz = std::sqrt(low * high);
    SeriesMatrix wave(n, 1);
    for (std::int64_t k = 0; k < n; ++k)
      wave(k, 0) = std::cos(2.0 * std::numbers::pi * at_hz * static_cast<double>(k - middle) / rate_hz);
    run_filter(colour, hz, rate_hz, wave);
    (wave(middle, 0) > std::sqrt(0.5) ? low : high) = at_hz;
  }
  return std::sqrt(low * high);
}

SeriesMatrix with_noise_of_colour(const std::string& colour, const SeriesMatrix& path, double sd,
                                  Random& random) {
  SeriesMatrix x = path;
  const std::int64_t n = x.rows();
  if (colour.starts_with("ar")) {
    const double rho = std::atof(colour.c_str() + 2), fresh = std::sqrt(1.0 - rho * rho);
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      double e = random.gaussian();
      for (std::int64_t i = 0; i < n; ++i, e = rho * e + fresh * random.gaussian()) x(i, k) += sd * e;
    }
    return x;
  }
  for (std::int64_t i = 0; i < n; ++i) {
    const bool flickers = colour == "flicker" && random.uniform() < 0.02;
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      x(i, k) += sd * (colour == "t3" ? student(random) : random.gaussian());
      if (flickers) x(i, k) += 10.0 * sd * random.gaussian();
    }
  }
  return x;
}

}  // namespace kinemark::acceptance

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/digital_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "kinemark/core/check.h"

namespace kinemark::math {
namespace {

double two_pass_factor(int order) { return std::pow(std::sqrt(2.0) - 1.0, 1.0 / (2.0 * order)); }

/// One section in transposed direct form II, started in the steady state of a constant x[0].
void run(const Biquad& s, std::vector<double>& x) {
  // Steady state for input 1 and output g = H(1): z2 = b2 - a2 g, z1 = b1 - a1 g + z2.
  const double g = (s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2);
  double z2 = (s.b2 - s.a2 * g) * x.front();
  double z1 = (s.b1 - s.a1 * g) * x.front() + z2;
  for (double& v : x) {
    const double y = s.b0 * v + z1;
    z1 = s.b1 * v - s.a1 * y + z2;
    z2 = s.b2 * v - s.a2 * y;
    v = y;
  }
}

}  // namespace

std::vector<Biquad> butterworth_lowpass(int order, double cutoff) {
  check(order >= 1 && order <= 20, "a Butterworth filter has an order of 1 to 20");
  check(cutoff > 0.0 && cutoff < 0.5, "a cut-off lies between 0 and half the sampling rate");
  const double w = std::tan(M_PI * cutoff);  // prewarped, with z = (1 + s) / (1 - s)
  std::vector<Biquad> sections;
  for (int k = 0; k < order / 2; ++k) {
    // Poles in pairs: s^2 + 2 w sin(theta) s + w^2.
    const double damping = 2.0 * w * std::sin(M_PI * (2 * k + 1) / (2.0 * order));
    const double a0 = 1.0 + damping + w * w;
    const double b = w * w / a0;
    sections.push_back({b, 2.0 * b, b, 2.0 * (w * w - 1.0) / a0, (1.0 - damping + w * w) / a0});
  }
  if (order % 2 == 1) sections.push_back({w / (1.0 + w), w / (1.0 + w), 0.0, (w - 1.0) / (1.0 + w), 0.0});
  return sections;
}

double two_pass_cutoff(int order, double cutoff) {
  check(order >= 1 && cutoff > 0.0 && cutoff < 0.5, "a cut-off lies between 0 and half the sampling rate");
  return std::atan(std::tan(M_PI * cutoff) / two_pass_factor(order)) / M_PI;
}

double two_pass_half_power(int order, double design_cutoff) {
  return std::atan(std::tan(M_PI * design_cutoff) * two_pass_factor(order)) / M_PI;
}

double amplitude(std::span<const Biquad> sections, double frequency) {
  const std::complex<double> back = std::polar(1.0, -2.0 * M_PI * frequency);
  double product = 1.0;
  for (const Biquad& s : sections)
    product *= std::abs((s.b0 + back * (s.b1 + back * s.b2)) / (1.0 + back * (s.a1 + back * s.a2)));
  return product;
}

void filter_both_ways(std::span<const Biquad> sections, int padding, std::vector<double>& x) {
  check(padding >= 0, "padding is not negative");
  const auto n = std::ssize(x);
  if (n < 2) return;
  const std::ptrdiff_t pad = std::min<std::ptrdiff_t>(padding, n - 1);
  std::vector<double> wide(static_cast<std::size_t>(n + 2 * pad));
  for (std::ptrdiff_t i = 1; i <= pad; ++i) {
    wide[static_cast<std::size_t>(pad - i)] = 2.0 * x.front() - x[static_cast<std::size_t>(i)];
    wide[static_cast<std::size_t>(pad + n - 1 + i)] = 2.0 * x.back() - x[static_cast<std::size_t>(n - 1 - i)];
  }
  std::ranges::copy(x, wide.begin() + pad);
  for (int way = 0; way < 2; ++way) {
    for (const Biquad& section : sections) run(section, wide);
    std::ranges::reverse(wide);
  }
  std::copy_n(wide.begin() + pad, n, x.begin());
}

}  // namespace kinemark::math

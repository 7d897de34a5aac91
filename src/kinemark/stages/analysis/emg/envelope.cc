// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/envelope.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/stages/analysis/path/spectrum.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kOrder = 4;
constexpr double kHighestShare = 0.45;  // of the rate
constexpr double kWindow_s = 0.5;

// The low-pass of 0.5 - c with z for -z is the high-pass of c.
std::vector<math::Biquad> butterworth_highpass(int order, double cutoff) {
  auto sections = math::butterworth_lowpass(order, 0.5 - cutoff);
  for (auto& s : sections) s.b1 = -s.b1, s.a1 = -s.a1;
  return sections;
}

// Both ways, with ends that are continued for as long as the filter remembers.
void filter(std::span<const math::Biquad> sections, double cutoff, std::vector<double>& x) {
  math::filter_both_ways(sections,
                         std::max(math::usual_padding(kOrder), static_cast<int>(std::ceil(1.0 / cutoff))), x);
}

std::vector<double> values_of(const VectorXd& x) { return {x.data(), x.data() + x.size()}; }
VectorXd vector_of(const std::vector<double>& x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

VectorXd moving_rms(const VectorXd& x, Index half) {
  const auto n = x.size();
  std::vector<double> sum(at(n + 1), 0.0);
  for (Index i = 0; i < n; ++i) sum[at(i + 1)] = sum[at(i)] + x[i] * x[i];
  VectorXd out(n);
  for (Index i = 0; i < n; ++i) {
    const Index begin = std::max<Index>(0, i - half), end = std::min(n, i + half + 1);
    out[i] = std::sqrt(std::max(0.0, sum[at(end)] - sum[at(begin)]) / static_cast<double>(end - begin));
  }
  return out;
}

}  // namespace

Status EnvelopeOptions::check() const {
  const bool known = high_pass_hz >= 0.0 && low_pass_hz > high_pass_hz && envelope_hz > 0.0 &&
                     rms_window_s >= 0.0 && std::isfinite(low_pass_hz) && std::isfinite(envelope_hz) &&
                     std::isfinite(rms_window_s);
  if (known) return {};
  return fail(
      Code::usage,
      fmt::format("an EMG's band from {:g} to {:g} Hz, envelope of {:g} Hz and window of {:g} s; need a band "
                  "that rises, an envelope above 0 and a window that is not negative",
                  high_pass_hz, low_pass_hz, envelope_hz, rms_window_s));
}

VectorXd band_passed(const VectorXd& x, double rate_hz, const EnvelopeOptions& options) {
  auto values = values_of(x);
  if (options.high_pass_hz > 0.0 && options.high_pass_hz < kHighestShare * rate_hz)
    filter(butterworth_highpass(kOrder, options.high_pass_hz / rate_hz), options.high_pass_hz / rate_hz,
           values);
  if (options.low_pass_hz < kHighestShare * rate_hz)
    filter(math::butterworth_lowpass(kOrder, options.low_pass_hz / rate_hz), options.low_pass_hz / rate_hz,
           values);
  return vector_of(values);
}

VectorXd envelope_of(const VectorXd& band, double rate_hz, const EnvelopeOptions& options) {
  if (options.rms_window_s > 0.0) return moving_rms(band, std::llround(0.5 * options.rms_window_s * rate_hz));
  auto values = values_of(band.cwiseAbs());
  if (options.envelope_hz < kHighestShare * rate_hz)
    filter(math::butterworth_lowpass(kOrder, options.envelope_hz / rate_hz), options.envelope_hz / rate_hz,
           values);
  return vector_of(values).cwiseMax(0.0);
}

double median_frequency(const VectorXd& band, double rate_hz) {
  const Index n = std::min<Index>(band.size(), std::llround(kWindow_s * rate_hz));
  if (n < 8) return kNaN;
  VectorXd window(n);
  for (Index i = 0; i < n; ++i)
    window[i] =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
  const Index length = 2 * n;
  VectorXd power = VectorXd::Zero(length / 2 + 1);
  for (Index begin = 0; begin + n <= band.size(); begin += std::max<Index>(1, n / 2)) {
    const VectorXd part = band.segment(begin, n).array() - band.segment(begin, n).mean();
    power += amplitudes(part.cwiseProduct(window), length).array().square().matrix();
  }
  const double half = 0.5 * power.sum();
  if (!(half > 0.0)) return kNaN;
  double sum = 0.0;
  for (Index k = 0; k < power.size(); ++k) {
    sum += power[k];
    if (sum >= half)
      return (static_cast<double>(k) - (sum - half) / power[k] + 0.5) * rate_hz / static_cast<double>(length);
  }
  return kNaN;
}

}  // namespace kinemark::analysis

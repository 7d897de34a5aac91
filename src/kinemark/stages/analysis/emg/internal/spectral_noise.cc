// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/spectral_noise.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSmooth_hz = 4.0;  // of the spectrum, to both sides

}  // namespace

SpectralNoise::SpectralNoise(const VectorXd& series, double rate_hz) : samples_(series.size()) {
  length_ = 8;
  while (length_ < samples_) length_ *= 2;
  std::vector<std::complex<double>> padded(at(length_)), spectrum;
  for (Index i = 0; i < samples_; ++i) padded[at(i)] = series[i];
  transform_.fwd(spectrum, padded);
  for (Index k = 0; k <= length_ / 2; ++k) amplitude_.push_back(std::abs(spectrum[at(k)]));
  // Power over neighbouring frequencies: that of one is a draw itself.
  const auto half =
      std::max<Index>(8, static_cast<Index>(kSmooth_hz * static_cast<double>(length_) / rate_hz));
  std::vector<double> smooth(amplitude_.size());
  for (Index k = 0; k <= length_ / 2; ++k) {
    double sum = 0.0, count = 0.0;
    for (Index j = std::max<Index>(0, k - half); j <= std::min(length_ / 2, k + half); ++j)
      sum += amplitude_[at(j)] * amplitude_[at(j)], count += 1.0;
    smooth[at(k)] = std::sqrt(sum / count);
  }
  amplitude_ = std::move(smooth);
  double power = 0.0;
  for (Index k = 0; k <= length_ / 2; ++k)
    power += (k == 0 || 2 * k == length_ ? 1.0 : 2.0) * amplitude_[at(k)] * amplitude_[at(k)];
  for (double& a : amplitude_) a *= power > 0.0 ? static_cast<double>(length_) / std::sqrt(power) : 0.0;
}

double SpectralNoise::median_hz(double rate_hz) const {
  double whole = 0.0, sum = 0.0;
  for (const double a : amplitude_) whole += a * a;
  for (std::size_t k = 0; k < amplitude_.size(); ++k) {
    const double power = amplitude_[k] * amplitude_[k];
    sum += power;
    if (sum >= 0.5 * whole && power > 0.0)
      return (static_cast<double>(k) + 0.5 - (sum - 0.5 * whole) / power) * rate_hz /
             static_cast<double>(length_);
  }
  return kNaN;
}

double SpectralNoise::freedom_of_a_sample() const {
  // Squares of autocorrelations sum to the mean square of the power over the square of its mean (Parseval).
  double sum = 0.0, squares = 0.0;
  for (const double a : amplitude_) sum += a * a, squares += a * a * a * a;
  return squares > 0.0 ? sum * sum / (squares * static_cast<double>(amplitude_.size())) : kNaN;
}

double SpectralNoise::variance_of_rectified() {
  std::vector<std::complex<double>> power(at(length_)), correlation;
  for (Index i = 0; i < length_; ++i) power[at(i)] = std::pow(amplitude_[at(std::min(i, length_ - i))], 2);
  transform_.inv(correlation, power);
  const double variance = correlation[0].real();
  if (!(variance > 0.0)) return 0.0;
  // Covariances of |x| and |y|, of Gaussian x and y of unit variance.
  double sum = 0.0;
  for (const auto& c : correlation) {
    const double r = std::clamp(c.real() / variance, -1.0, 1.0);
    sum += 2.0 * std::numbers::inv_pi * (std::sqrt(1.0 - r * r) + r * std::asin(r) - 1.0);
  }
  return sum;
}

VectorXd SpectralNoise::draw(std::uint64_t seed, std::uint64_t stream, std::int64_t k) {
  Random random(seed, mix64(stream) ^ static_cast<std::uint64_t>(k));
  std::vector<std::complex<double>> spectrum(at(length_)), series;
  for (Index i = 0; i <= length_ / 2; ++i) {
    const double re = random.gaussian(), im = random.gaussian();
    const bool real = i == 0 || 2 * i == length_;
    const std::complex<double> value =
        real ? std::complex<double>(re, 0.0) : std::complex<double>(re, im) / std::numbers::sqrt2;
    spectrum[at(i)] = amplitude_[at(i)] * value;
    if (!real) spectrum[at(length_ - i)] = std::conj(spectrum[at(i)]);
  }
  transform_.inv(series, spectrum);
  VectorXd out(samples_);
  for (Index i = 0; i < samples_; ++i) out[i] = series[at(i)].real();
  return out;
}

}  // namespace kinemark::analysis

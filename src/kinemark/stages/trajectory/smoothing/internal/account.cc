// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/account.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/stages/trajectory/smoothing/internal/stretches.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::size_t kAccountLags = 10;
constexpr std::int64_t kFewestPairs = 30;
constexpr double kMuch = 0.15;  ///< autocorrelation that is relevant for any length of recording
constexpr std::int64_t kShortestSegment = 32, kLongestSegment = 512;
constexpr int kMostFrequencies = 24;

/// Chance that a chi-square variable of an even number of degrees of freedom exceeds x.
double chi_square_above(double x, int freedom) {
  double term = std::exp(-0.5 * x), sum = term;
  for (int i = 1; i < freedom / 2; ++i) sum += term *= 0.5 * x / i;
  return std::min(1.0, sum);
}

void autocorrelate(const MarkerSamples& samples, const std::vector<double>& residual,
                   data::MarkerAccount& account) {
  double power = 0.0, count = 0.0;
  for (const double r : residual) {
    if (std::isnan(r)) continue;
    power += r * r;
    count += 1.0;
  }
  account.residual_rms_m = count > 0.0 ? std::sqrt(power / count) : kNaN;
  if (!(power > 0.0)) return;
  std::vector<double> found;
  double q = 0.0, worst = 0.0;
  for (std::size_t lag = 1; lag <= kAccountLags; ++lag) {
    double product = 0.0, pairs = 0.0;
    for (std::size_t i = 3 * lag; i < residual.size(); ++i) {
      const double both = residual[i] * residual[i - 3 * lag];
      if (std::isnan(both)) continue;
      product += both;
      pairs += 1.0;
    }
    if (pairs < kFewestPairs) return;
    const double rho = product / pairs * count / power;
    found.push_back(rho);
    q += rho * rho * pairs;
    worst = std::max(worst, std::abs(rho) - 2.0 / std::sqrt(pairs));
  }
  account.autocorrelation = std::move(found);
  account.ljung_box_p = chi_square_above(q, kAccountLags);
  // The filter itself takes the slow part of white noise out of the residual: about the band's share.
  const double own =
      std::isnan(account.used.cutoff_hz) ? 0.0 : 2.0 * account.used.cutoff_hz * samples.interval_s;
  account.white = worst <= std::max(kMuch, 1.5 * own);
}

/// Hann-windowed periodograms of stretches, at log-spaced frequencies; `width` numbers per frame, summed over
/// three axes.
class Psd {
 public:
  Psd(std::int64_t length, double rate_hz) : length_(length), rate_hz_(rate_hz) {
    const auto highest = static_cast<double>(length / 2);
    for (int i = 0; i < kMostFrequencies; ++i) {
      const auto bin =
          static_cast<std::int64_t>(std::llround(std::pow(highest, (i + 0.5) / kMostFrequencies)));
      if (bins_.empty() || bin > bins_.back()) bins_.push_back(bin);
    }
  }
  [[nodiscard]] std::vector<double> frequencies() const {
    std::vector<double> f;
    for (const std::int64_t bin : bins_)
      f.push_back(static_cast<double>(bin) * rate_hz_ / static_cast<double>(length_));
    return f;
  }
  /// `x`: 3 numbers a frame, from the segment's first frame.
  void add(const double* x, std::vector<double>& power) const {
    power.resize(bins_.size(), 0.0);
    const auto n = static_cast<double>(length_);
    for (int axis = 0; axis < 3; ++axis) {
      double mean = 0.0, window_power = 0.0;
      for (std::int64_t k = 0; k < length_; ++k) mean += x[3 * k + axis] / n;
      std::vector<double> windowed(static_cast<std::size_t>(length_));
      for (std::int64_t k = 0; k < length_; ++k) {
        const double w = 0.5 - 0.5 * std::cos(2.0 * M_PI * (static_cast<double>(k) + 0.5) / n);
        windowed[static_cast<std::size_t>(k)] = w * (x[3 * k + axis] - mean);
        window_power += w * w;
      }
      for (std::size_t b = 0; b < bins_.size(); ++b) {
        // Goertzel: one frequency by one recursion.
        const double twice = 2.0 * std::cos(2.0 * M_PI * static_cast<double>(bins_[b]) / n);
        double s1 = 0.0, s2 = 0.0;
        for (const double v : windowed) {
          const double s0 = v + twice * s1 - s2;
          s2 = s1;
          s1 = s0;
        }
        power[b] += 2.0 * (s1 * s1 + s2 * s2 - twice * s1 * s2) / (rate_hz_ * window_power);
      }
    }
  }

 private:
  std::int64_t length_;
  double rate_hz_;
  std::vector<std::int64_t> bins_;
};

data::Spectrum spectrum(const MarkerSamples& samples, const std::vector<double>& residual, double rate_hz) {
  std::int64_t longest = 0;
  const auto all = sample_of(stretches(samples.judged));
  for (const Stretch& s : all) longest = std::max(longest, s.length());
  if (longest < kShortestSegment) return {};
  const std::int64_t length = std::min(longest, kLongestSegment);
  const Psd psd(length, rate_hz);
  data::Spectrum out;
  out.frequency_hz = psd.frequencies();
  double segments = 0.0;
  for (const Stretch& s : all) {
    for (std::int64_t at = s.begin; at + length <= s.end; at += length) {
      psd.add(samples.x.data() + 3 * at, out.raw_m2_per_hz);
      psd.add(residual.data() + 3 * at, out.residual_m2_per_hz);
      segments += 1.0;
    }
  }
  for (double& v : out.raw_m2_per_hz) v /= segments;
  for (double& v : out.residual_m2_per_hz) v /= segments;
  return out;
}

}  // namespace

void judge_residuals(const MarkerSamples& samples, double rate_hz, MarkerResult& result) {
  data::MarkerAccount& account = result.account;
  std::vector<double> residual(static_cast<std::size_t>(3 * samples.frames), kNaN);
  for (std::int64_t f = 0; f < samples.frames; ++f)
    if (samples.judged[static_cast<std::size_t>(f)] != 0)
      for (auto i = static_cast<std::size_t>(3 * f); i < static_cast<std::size_t>(3 * f + 3); ++i)
        residual[i] = samples.x[i] - result.x[i];
  autocorrelate(samples, residual, account);
  account.spectrum = spectrum(samples, residual, rate_hz);
  if (account.used.method == "none" || account.autocorrelation.empty()) return;
  account.words +=
      account.white ? fmt::format(" The residual ({:.2g} mm rms) is consistent with white noise.",
                                  1e3 * account.residual_rms_m)
                    : fmt::format(
                          " The residual ({:.2g} mm rms) is not white (autocorrelation {:.2f} at one "
                          "frame): the noise is coloured, the recording was filtered before, or movement was "
                          "lost; the error bars are then too small.",
                          1e3 * account.residual_rms_m, account.autocorrelation.front());
}

}  // namespace kinemark::trajectory::smoothing

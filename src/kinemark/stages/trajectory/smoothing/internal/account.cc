// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/account.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/internal/whiteness.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::size_t kAccountLags = 10;
constexpr std::int64_t kFewestPairs = 30;
constexpr std::int64_t kShortestSegment = 32, kLongestSegment = 512;
constexpr int kMostFrequencies = 24;

void autocorrelate(const std::vector<double>& residual, data::MarkerAccount& account) {
  double power = 0.0, count = 0.0;
  for (const double r : residual) {
    if (std::isnan(r)) continue;
    power += r * r;
    count += 1.0;
  }
  account.residual_rms_m = count > 0.0 ? std::sqrt(power / count) : kNaN;
  if (!(power > 0.0)) return;
  std::vector<double> found;
  for (std::size_t lag = 1; lag <= kAccountLags; ++lag) {
    double product = 0.0, pairs = 0.0;
    for (std::size_t i = 3 * lag; i < residual.size(); ++i) {
      const double both = residual[i] * residual[i - 3 * lag];
      if (std::isnan(both)) continue;
      product += both;
      pairs += 1.0;
    }
    if (pairs < kFewestPairs) return;
    found.push_back(product / pairs * count / power);
  }
  account.autocorrelation = std::move(found);
}

/// Autocorrelation that 1 - H, whose response to an impulse is given, makes of white noise.
std::vector<double> autocorrelation_if_white(std::span<const double> impulse_response, std::size_t lags) {
  std::vector<double> kernel(impulse_response.size()), found;
  std::ranges::transform(impulse_response, kernel.begin(), std::negate<>());
  kernel[kernel.size() / 2] += 1.0;
  const double power = std::inner_product(kernel.begin(), kernel.end(), kernel.begin(), 0.0);
  for (std::size_t lag = 1; lag <= lags && power > 0.0; ++lag)
    found.push_back(std::inner_product(kernel.begin(), kernel.end() - static_cast<std::ptrdiff_t>(lag),
                                       kernel.begin() + static_cast<std::ptrdiff_t>(lag), 0.0) /
                    power);
  return found;
}

/// Hann-windowed periodograms of stretches, at log-spaced frequencies; `width` numbers per frame, summed over
/// three axes.
class Psd {
 public:
  Psd(std::int64_t length, double rate_hz) : length_(length), rate_hz_(rate_hz) {
    const std::int64_t last = length / 2;
    const auto highest = static_cast<double>(last);
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

/// "p = 0.23" or "p < 0.001".
std::string probability(double p) { return p < 0.001 ? "p < 0.001" : fmt::format("p = {:.2g}", p); }

std::string describe_residual(const data::MarkerAccount& account) {
  const std::string size = fmt::format(" The residual ({:.2g} mm rms)", 1e3 * account.residual_rms_m);
  if (!account.judged())
    return size +
           " is too short, or too little of its band is left by the filter, to tell whether it is white.";
  const std::string test = fmt::format("cumulative periodogram, {}", probability(account.white_p));
  if (!account.coloured()) return fmt::format("{} is consistent with white noise ({}).", size, test);
  return fmt::format(
      "{} is not white ({}): {:.0f} % of the noise power lies too {}, because the noise is coloured, the "
      "recording was "
      "filtered before, or movement was lost; the error bars, which assume white noise, are then too {}.",
      size, test, 100.0 * std::abs(account.white_departure),
      account.white_departure > 0.0 ? "low in frequency" : "high in frequency",
      account.white_departure > 0.0 ? "small" : "large");
}

}  // namespace

void judge_residuals(const MarkerSamples& samples, std::span<const double> impulse_response, double rate_hz,
                     MarkerResult& result) {
  data::MarkerAccount& account = result.account;
  std::vector<double> residual(static_cast<std::size_t>(3 * samples.frames), kNaN);
  for (std::int64_t f = 0; f < samples.frames; ++f)
    if (samples.judged[static_cast<std::size_t>(f)] != 0)
      for (auto i = static_cast<std::size_t>(3 * f); i < static_cast<std::size_t>(3 * f + 3); ++i)
        residual[i] = samples.x[i] - result.x[i];
  autocorrelate(residual, account);
  account.spectrum = spectrum(samples, residual, rate_hz);
  if (impulse_response.empty() || !(account.residual_rms_m > 0.0)) return;
  account.white_autocorrelation = autocorrelation_if_white(impulse_response, account.autocorrelation.size());
  const Whiteness whiteness =
      test_whiteness(residual, stretches(samples.judged), impulse_response, account.used.cutoff_hz, rate_hz);
  account.white_p = whiteness.p;
  account.white_departure = whiteness.departure;
  account.description += describe_residual(account);
}

}  // namespace kinemark::trajectory::smoothing

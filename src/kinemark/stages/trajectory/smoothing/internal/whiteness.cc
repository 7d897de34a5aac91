// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/whiteness.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::int64_t kMostStretches = 32, kFewestFrames = 64, kFewestBins = 8;
constexpr double kFewestFrequencies = 0.1;  ///< of all
constexpr double kTakenPower = 0.5;         ///< least |1 - H|^2 of a frequency that is looked at

/// |DFT|^2 at `bin` of `length` numbers that lie `stride` apart (Goertzel).
double power_at(const double* x, std::int64_t length, std::int64_t stride, std::int64_t bin) {
  const double twice = 2.0 * std::cos(2.0 * M_PI * static_cast<double>(bin) / static_cast<double>(length));
  double s1 = 0.0, s2 = 0.0;
  for (std::int64_t k = 0; k < length; ++k) {
    const double s0 = x[k * stride] + twice * s1 - s2;
    s2 = s1;
    s1 = s0;
  }
  return s1 * s1 + s2 * s2 - twice * s1 * s2;
}

/// |1 - H|^2 at `frequency`, in cycles a frame.
double taken_power(std::span<const double> impulse_response, double frequency) {
  const auto middle = static_cast<double>(impulse_response.size() / 2);
  double amplitude = 1.0;
  for (std::size_t k = 0; k < impulse_response.size(); ++k)
    amplitude -= impulse_response[k] * std::cos(2.0 * M_PI * frequency * (static_cast<double>(k) - middle));
  return amplitude * amplitude;
}

/// First frames of stretches of `length` without overlap, spread evenly over what there is.
std::vector<std::int64_t> choose_begins(const std::vector<Stretch>& inner, std::int64_t length) {
  std::vector<std::int64_t> all;
  for (const Stretch& s : inner)
    for (std::int64_t begin = s.begin; begin + length <= s.end; begin += length) all.push_back(begin);
  const std::int64_t kept = std::min<std::int64_t>(kMostStretches, std::ssize(all));
  std::vector<std::int64_t> chosen;
  for (std::int64_t i = 0; i < kept; ++i) chosen.push_back(all[at(i * std::ssize(all) / kept)]);
  return chosen;
}

/// Chance that Kolmogorov's statistic of n uniform numbers exceeds d; Stephens (1970), J R Stat Soc B 32:115.
double kolmogorov_above(double d, double n) {
  const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * d;
  if (lambda < 0.2) return 1.0;
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

Whiteness test_whiteness(std::span<const double> residual, const std::vector<Stretch>& usable,
                         std::span<const double> impulse_response, double cutoff_hz, double rate_hz) {
  if (!(cutoff_hz > 0.0)) return {};
  const auto margin = static_cast<std::int64_t>(std::ceil(std::min(rate_hz / cutoff_hz, 1e9)));
  std::vector<Stretch> inner;
  std::int64_t longest = 0;
  for (const Stretch& s : usable) {
    inner.push_back({s.begin + margin, s.end - margin});
    longest = std::max(longest, inner.back().length());
  }
  const std::int64_t length = std::min(longest, kWhitenessFrames);
  if (length < kFewestFrames) return {};
  const std::vector<std::int64_t> begins = choose_begins(inner, length);

  std::vector<std::int64_t> bins;
  std::vector<double> taken;
  for (std::int64_t bin = 1; 2 * bin < length; ++bin) {
    const double power =
        taken_power(impulse_response, static_cast<double>(bin) / static_cast<double>(length));
    if (power < kTakenPower) continue;
    bins.push_back(bin);
    taken.push_back(power);
  }
  if (std::ssize(bins) < kFewestBins ||
      static_cast<double>(bins.size()) < kFewestFrequencies * 0.5 * static_cast<double>(length))
    return {};

  std::vector<double> flat(bins.size(), 0.0);  // mean 1 in each axis
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> power(bins.size(), 0.0);
    double sum = 0.0;
    for (std::size_t b = 0; b < bins.size(); ++b) {
      for (const std::int64_t begin : begins)
        power[b] += power_at(residual.data() + 3 * begin + axis, length, 3, bins[b]);
      sum += power[b] /= taken[b];
    }
    if (!(sum > 0.0)) continue;
    ++axes;
    for (std::size_t b = 0; b < bins.size(); ++b) flat[b] += power[b] / sum;
  }
  if (axes == 0) return {};

  Whiteness out;
  out.lowest_hz = static_cast<double>(bins.front()) * rate_hz / static_cast<double>(length);
  out.departure = 0.0;
  double cumulated = 0.0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    cumulated += flat[b] / axes;
    const double apart = cumulated - static_cast<double>(b + 1) / static_cast<double>(bins.size());
    if (std::abs(apart) > std::abs(out.departure)) out.departure = apart;
  }
  const double ordinates = static_cast<double>(bins.size() * begins.size()) * axes;
  out.p = kolmogorov_above(std::abs(out.departure), ordinates);
  return out;
}

}  // namespace kinemark::trajectory::smoothing

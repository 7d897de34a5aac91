// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/activity.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/emg/internal/burst_edges.h"
#include "kinemark/stages/analysis/emg/internal/spectral_noise.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kBin_s = 0.010;    // half a period of 50 Hz: hum of the mains has the same power in each
constexpr double kSlow_s = 0.1;     // of the strength that noise is freed of
constexpr double kGate_s = 0.2;     // half a period of the gate that shows what the filter spreads
constexpr std::int64_t kReach = 4;  // bins
constexpr double kQuiet_s = 0.5, kBurst_s = 0.7;  // beside an edge that are looked at
constexpr double kJudged_s =
    0.25;  // of a quiet part: a strength that changes twice a second has shorter ones
constexpr double kApart_s = 0.025;  // of rest from bursts
constexpr double kLeast = 1e-12;    // of the mean power: a channel may hold zeros

std::vector<double> power_of_bins(const VectorXd& band, Index width) {
  std::vector<double> out(at(band.size() / width));
  const double least = kLeast * band.squaredNorm() / static_cast<double>(band.size());
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b] = std::max(
        least, band.segment(static_cast<Index>(b) * width, width).squaredNorm() / static_cast<double>(width));
  return out;
}

// The noise that the strength modulates.
VectorXd without_strength(const VectorXd& band, double rate_hz) {
  const auto slow = envelope_of(band, rate_hz, {.rms_window_s = kSlow_s});
  return band.cwiseQuotient(slow.cwiseMax(1e-6 * slow.maxCoeff()));
}

// How power that begins at once comes out of the band's filter: weights of neighbouring bins.
std::vector<double> spread_of_filter(SpectralNoise& noise, Index width, double rate_hz,
                                     const EnvelopeOptions& band, std::uint64_t seed) {
  VectorXd gated = noise.draw(seed, 78, 0);
  const auto half = std::max<Index>(2 * (kReach + 1), std::llround(kGate_s / kBin_s)) * width;
  for (Index i = 0; i < gated.size(); ++i) gated[i] *= (i / half) % 2 == 1 ? 1.0 : 0.0;
  const VectorXd passed = band_passed(gated, rate_hz, band);
  std::vector<double> step(at(2 * kReach), 0.0);  // bins before and behind a gate that opens
  for (Index edge = half; edge + half <= passed.size(); edge += half) {
    const bool opens = (edge / half) % 2 == 1;
    for (std::int64_t b = -kReach; b < kReach; ++b)
      step[at(kReach + b)] +=
          passed.segment(opens ? edge + b * width : edge - (b + 1) * width, width).squaredNorm();
  }
  double whole = 0.0;
  for (std::int64_t b = kReach - 2; b < kReach; ++b) whole += 0.5 * step[at(kReach + b)];
  std::vector<double> out(at(2 * kReach + 1), 0.0);
  out[at(kReach)] = 1.0;
  if (!(whole > 0.0)) return out;
  double last = 0.0, sum = 0.0;
  for (std::int64_t b = -kReach; b <= 0; ++b) {
    const double now = b < 0 ? std::clamp(step[at(kReach + b)] / whole, 0.0, 0.5) : 1.0;
    const double before = std::max(0.0, now - last);
    last = std::max(last, now);
    if (b == 0) break;
    out[at(kReach + b)] = out[at(kReach - b)] = before;
    sum += 2.0 * before;
  }
  out[at(kReach)] = 1.0 - sum;
  return out;
}

std::vector<BurstEdge> edges_of(const std::vector<char>& active, double bin_s) {
  const auto n = std::ssize(active);
  std::vector<BurstEdge> out;
  std::vector<std::int64_t> changes{0};
  for (std::int64_t i = 1; i < n; ++i)
    if (active[at(i)] != active[at(i - 1)]) changes.push_back(i);
  changes.push_back(n);
  const auto most = [&](double s) { return std::max<std::int64_t>(1, std::llround(s / bin_s)); };
  for (std::size_t c = 1; c + 1 < changes.size(); ++c) {
    const auto here = changes[c];
    const bool onset = active[at(here)] != 0;
    // Half of a part that has another edge, all of one that the recording cuts.
    const auto own = [&](std::size_t a, std::size_t b, bool cut) {
      const auto length = changes[b] - changes[a];
      return std::max<std::int64_t>(1, cut ? length : length / 2);
    };
    const auto before = own(c - 1, c, c == 1), after = own(c, c + 1, c + 2 == changes.size());
    out.push_back({.bin = here,
                   .is_onset = onset,
                   .quiet = std::min(onset ? before : after, most(kQuiet_s)),
                   .burst = std::min(onset ? after : before, most(kBurst_s))});
  }
  return out;
}

// From instants of edges to bursts; those that the recording cuts begin or end with it.
std::vector<Burst> bursts_of(const std::vector<BurstEdge>& edges, const std::vector<double>& bins,
                             double width, double last) {
  std::vector<Burst> out;
  if (!edges.front().is_onset) out.push_back({.onset = 0.0});
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges[e].is_onset)
      out.push_back({.onset = bins[e] * width, .end = last});
    else
      out.back().end = bins[e] * width;
  return out;
}

}  // namespace

Activity find_activity(const VectorXd& band, double rate_hz, const ActivityOptions& options) {
  const auto width = std::max<Index>(1, std::llround(kBin_s * rate_hz));
  const double bin_s = static_cast<double>(width) / rate_hz;
  const auto power = power_of_bins(band, width);
  Activity out;
  out.rest.assign(at(band.size()), 0);
  SpectralNoise noise(without_strength(band, rate_hz), rate_hz);
  double freedom = noise.freedom_of_a_sample() * static_cast<double>(width);
  if (power.size() < 8 || !(freedom > 0.0)) return out;
  const double still = freedom;
  const auto levels = power_levels(power, freedom);
  const auto quiet = find_quiet(power, levels, freedom, still,
                                {.rest = options.rest_s / bin_s,
                                 .burst = options.burst_s / bin_s,
                                 .judged = std::min(kJudged_s, options.rest_s) / bin_s});
  out.found = quiet.found;
  if (quiet.found != Quiet::Found::bursts) return out;
  std::vector<double> of_bin;
  for (const auto& level : levels) of_bin.insert(of_bin.end(), at(level.end - level.first), level.power);
  const auto edges = edges_of(quiet.active, bin_s);
  const auto spread = spread_of_filter(noise, width, rate_hz, options.band, options.seed);
  const auto drawn =
      draw_edges(edges, power, of_bin, quiet.power, freedom, spread, bin_s, options.draws, options.seed);
  const double last = static_cast<double>(band.size() - 1), samples = static_cast<double>(width);
  for (const auto& bins : drawn) out.draws.push_back(bursts_of(edges, bins, samples, last));
  std::vector<double> median(edges.size()), one(drawn.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t d = 0; d < drawn.size(); ++d) one[d] = drawn[d][e];
    const auto middle = one.begin() + std::ssize(one) / 2;
    std::ranges::nth_element(one, middle);
    median[e] = *middle;
  }
  out.bursts = bursts_of(edges, median, samples, last);
  std::ranges::fill(out.rest, 1);
  const double apart = kApart_s * rate_hz;
  for (const auto& burst : out.bursts)
    for (auto i = std::max<std::int64_t>(0, std::llround(burst.onset - apart));
         i < std::min<std::int64_t>(band.size(), std::llround(burst.end + apart)); ++i)
      out.rest[at(i)] = 0;
  return out;
}

}  // namespace kinemark::analysis

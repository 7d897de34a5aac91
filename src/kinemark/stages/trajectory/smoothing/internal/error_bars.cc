// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/error_bars.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kWider = 1.6;                 ///< second run's cut-off over the first's
constexpr double kUsual = 0.9, kSpread = 0.6;  ///< prior of the shares of movement
constexpr double kMostMovement = 4.0;
constexpr double kInterior = 1.2;    ///< variance up to this times the least: samples all around
constexpr double kPriorHoles = 4.0;  ///< weight of "the model is right" in numbers of hidden stretches
constexpr int kPasses = 2;

struct Smoothed {
  explicit Smoothed(const Series& s)
      : state(static_cast<std::size_t>(s.frames * s.axes * 4)),
        variance(static_cast<std::size_t>(s.frames * 4)) {}
  std::vector<double> state, variance;
  SmoothedOut out() { return {state.data(), variance.data()}; }
};

/// With u = w / corner, H = 1 / (1 + u^2m), Hw the wider filter: integrals over the band of u^2k (Hw - H)^2
/// times the noise's spectrum and times the movement's as the model has it (u^-2m), in noise units.
struct Shares {
  double noise = 0.0, movement = 0.0;
};

Shares shares(int order, int derivative, double corner_times_interval) {
  const double top = std::min(M_PI / corner_times_interval, 8.0);
  constexpr int kSteps = 2000;
  Shares sum;
  for (int i = 0; i < kSteps; ++i) {
    const double u = top * (i + 0.5) / kSteps;
    const double p = std::pow(u, 2 * order);
    const double difference = 1.0 / (1.0 + p / std::pow(kWider, 2 * order)) - 1.0 / (1.0 + p);
    const double term = std::pow(u, 2 * derivative) * difference * difference;
    sum.noise += term;
    sum.movement += term / p;
  }
  const double scale = corner_times_interval / M_PI * top / kSteps;
  return {sum.noise * scale, sum.movement * scale};
}

/// Length of gaps inside, such that half of all missing frames lie in gaps at least as long; 0 when there are
/// none.
std::int64_t typical_gap(std::span<const Series> parts, std::int64_t longest) {
  std::vector<std::int64_t> lengths;
  std::int64_t missing = 0;
  for (const Series& part : parts) {
    std::int64_t latest = -1;
    for (std::int64_t k = 0; k < part.frames; ++k) {
      if (part.seen[k] == 0) continue;
      const std::int64_t gap = latest < 0 ? 0 : k - latest - 1;
      latest = k;
      if (gap == 0 || gap > longest) continue;
      lengths.push_back(gap);
      missing += gap;
    }
  }
  std::ranges::sort(lengths);
  std::int64_t counted = 0;
  for (const std::int64_t length : lengths) {
    counted += length;
    if (2 * counted >= missing) return length;
  }
  return 0;
}

class Scaler {
 public:
  Scaler(std::span<const Series> parts, int order, double cutoff_hz, double noise_sd_m)
      : parts_(parts),
        order_(order),
        cutoff_hz_(cutoff_hz),
        noise_sd_m_(noise_sd_m),
        corner_(corner_rad_s(order, cutoff_hz)) {
    scale_.interior.fill(std::numeric_limits<double>::infinity());
    for (const Series& part : parts_) {
      runs_.emplace_back(part);
      smooth_series(part, order, cutoff_hz, runs_.back().out());
      const auto& v = runs_.back().variance;
      for (std::size_t i = 0; i < v.size(); ++i)
        if (v[i] < scale_.interior[i % 4]) scale_.interior[i % 4] = v[i];
    }
  }

  void scale_seen() {
    std::array<double, 4> sum{}, count{};
    double interval = 0.0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Series& part = parts_[p];
      interval = part.interval_s;
      Smoothed wide(part);
      smooth_series(part, order_, kWider * cutoff_hz_, wide.out());
      for (std::int64_t k = 0; k < part.frames; ++k) {
        for (int d = 0; d < std::min(order_, 4); ++d) {
          if (!(runs_[p].variance[k * 4 + d] <= kInterior * scale_.interior[d])) continue;
          for (int axis = 0; axis < part.axes; ++axis) {
            const std::int64_t i = (k * part.axes + axis) * 4 + d;
            const double difference =
                (wide.state[i] - runs_[p].state[i]) / (noise_sd_m_ * std::pow(corner_, d));
            sum[d] += difference * difference;
            count[d] += 1.0;
          }
        }
      }
    }
    const double band_hz = (kWider - 1.0) * cutoff_hz_;
    for (int d = 0; d < std::min(order_, 4); ++d) {
      if (count[d] == 0.0) continue;
      const Shares expected = shares(order_, d, corner_ * interval);
      const double movement =
          std::clamp((sum[d] / count[d] - expected.noise) / expected.movement, 0.0, kMostMovement);
      const double freedom = std::max(2.0 * band_hz * interval * count[d], 1.0);
      const double doubt =
          std::sqrt(2.0 / freedom) * (expected.noise + expected.movement) / expected.movement;
      const double data = 1.0 / (doubt * doubt), prior = 1.0 / (kSpread * kSpread);
      const double likely = (movement * data + kUsual * prior) / (data + prior);
      const double share = (2.0 * d + 1.0) / (2.0 * order_);  // of movement in the model's variance
      scale_.seen[d] = 1.0 - share + share * likely;
    }
  }

  void scale_added() {
    std::array<double, 4> found{}, expected{};
    double holes = 0.0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Series& part = parts_[p];
      const double h = corner_ * part.interval_s;
      const auto reach = static_cast<std::int64_t>(std::max(1.0, 1.0 / h));
      std::int64_t length = typical_gap(parts_, static_cast<std::int64_t>(0.5 * kLongestGap / h));
      if (length == 0) length = reach;
      const std::int64_t spacing = length + std::max(2 * length, 8 * reach);
      Smoothed blind(part);
      std::vector<std::uint8_t> seen(static_cast<std::size_t>(part.frames));
      for (int pass = 0; pass < kPasses; ++pass) {
        std::copy_n(part.seen, part.frames, seen.begin());
        std::vector<std::int64_t> hidden;
        for (std::int64_t at = 4 * reach + pass * spacing / kPasses; at + length + 4 * reach <= part.frames;
             at += spacing) {
          holes += part.axes;
          for (std::int64_t k = at; k < at + length; ++k) {
            if (seen[static_cast<std::size_t>(k)] != 0) hidden.push_back(k);
            seen[static_cast<std::size_t>(k)] = 0;
          }
        }
        if (hidden.empty()) continue;
        Series with_holes = part;
        with_holes.seen = seen.data();
        smooth_series(with_holes, order_, cutoff_hz_, blind.out());
        for (const std::int64_t k : hidden)
          for (int d = 0; d < std::min(order_, 4); ++d)
            add(part, runs_[p], blind, k, d, found[d], expected[d]);
      }
    }
    for (int d = 0; d < std::min(order_, 4); ++d)
      if (expected[d] > 0.0)
        scale_.added[d] = (found[d] / expected[d] * holes + kPriorHoles) / (holes + kPriorHoles);
  }

  [[nodiscard]] const BarScale& scale() const { return scale_; }

 private:
  void add(const Series& part, const Smoothed& full, const Smoothed& blind, std::int64_t k, int d,
           double& found, double& expected) const {
    const double more = blind.variance[k * 4 + d] - full.variance[k * 4 + d];
    if (!std::isfinite(more)) return;
    for (int axis = 0; axis < part.axes; ++axis) {
      const std::int64_t i = (k * part.axes + axis) * 4 + d;
      const double difference = (blind.state[i] - full.state[i]) / noise_sd_m_;
      found += difference * difference;
      expected += more;
    }
  }

  std::span<const Series> parts_;
  int order_;
  double cutoff_hz_, noise_sd_m_, corner_;
  std::vector<Smoothed> runs_;
  BarScale scale_;
};

}  // namespace

BarScale scale_bars(std::span<const Series> parts, int order, double cutoff_hz, double noise_sd_m) {
  Scaler scaler(parts, order, cutoff_hz, noise_sd_m);
  scaler.scale_seen();
  scaler.scale_added();
  return scaler.scale();
}

}  // namespace kinemark::trajectory::smoothing

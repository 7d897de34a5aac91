// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/burst_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

constexpr std::array kRises_s{0.0, 0.010, 0.020, 0.030, 0.040, 0.060, 0.080, 0.120, 0.160, 0.320, 0.640};
constexpr double kStepWeight = 20.0;  // of a step before the data, beside each of the rises
constexpr double kFinest = 0.2;       // bins between instants that are tried, or a sixteenth of the rise
constexpr int kParts = 10;            // of a bin, over which a rise is averaged
constexpr double kLeastRise = 1e-6;   // bins
constexpr double kWithinBin = 0.15;   // bins: what no shape of ours says about a beginning within one
constexpr double kLeastBurst = 1.2;   // of rest
// Evidence on the shape counts as that of so many edges: no shape of ours is the true one.
constexpr double kEvidence = 2.0;

struct Rise {
  double bins = 0.0;
  bool is_cosine = false;
  [[nodiscard]] double step() const { return std::max(kFinest, bins / 16.0); }
  // Share of the amplitude, `bins` after the beginning, squared.
  [[nodiscard]] double power(double after) const {
    const double x = std::clamp(after / std::max(bins, kLeastRise), 0.0, 1.0);
    return std::pow(is_cosine ? 0.5 - 0.5 * std::cos(std::numbers::pi * x) : x, 2);
  }
};

std::vector<Rise> rises(double bin_s) {
  std::vector<Rise> out;
  for (const double s : kRises_s)
    for (const bool is_cosine : {false, true})
      if (s > 0.0 || !is_cosine) out.push_back({s / bin_s, is_cosine});
  return out;
}

// The surroundings of an edge, its quiet side first.
class Surroundings {
 public:
  Surroundings(const BurstEdge& edge, const std::vector<double>& power, const std::vector<double>& levels,
               double rest, double freedom, const std::vector<double>& spread)
      : rest_(rest), freedom_(freedom), spread_(spread), reach_(std::ssize(spread) / 2) {
    const auto size = edge.quiet + edge.burst;
    for (std::int64_t i = 0; i < size; ++i) {
      const auto bin = edge.is_onset ? edge.bin - edge.quiet + i : edge.bin + edge.quiet - 1 - i;
      power_.push_back(power[at(bin)]);
      excess_.push_back(std::max(levels[at(bin)], kLeastBurst * rest) - rest);
    }
    std::fill(excess_.begin(), excess_.begin() + edge.quiet, excess_[at(edge.quiet)]);
    quiet_cost_.push_back(0.0), active_cost_.push_back(0.0);
    const auto whole = [this](std::int64_t i) {
      return excess_[at(std::clamp<std::int64_t>(i, 0, size_() - 1))];
    };
    for (std::int64_t i = 0; i < size; ++i) {
      quiet_cost_.push_back(quiet_cost_.back() + cost(rest_, i));
      active_cost_.push_back(active_cost_.back() + cost(rest_ + spread_over(i, whole), i));
    }
  }

  [[nodiscard]] double last_instant() const { return static_cast<double>(size_() - 1); }

  /// Of a rise that begins at `instant`, logarithm.
  [[nodiscard]] double likelihood(double instant, const Rise& rise) const {
    const auto begin = static_cast<std::int64_t>(std::floor(instant)),
               full = std::min(size_() - 1, static_cast<std::int64_t>(std::ceil(instant + rise.bins)));
    const double height = excess_[at(full)];
    std::vector<double> risen;
    for (std::int64_t i = begin; i <= full; ++i) {
      double sum = 0.0;
      for (int p = 0; p < kParts; ++p)
        sum += rise.power(static_cast<double>(i) + (p + 0.5) / kParts - instant);
      risen.push_back(height * sum / kParts);
    }
    const auto excess = [&](std::int64_t i) {
      if (i < begin) return 0.0;
      return i <= full ? risen[at(i - begin)] : excess_[at(std::min(i, size_() - 1))];
    };
    const auto first = std::max<std::int64_t>(0, begin - reach_), last = std::min(size_(), full + reach_ + 1);
    double sum = quiet_cost_[at(first)] + active_cost_.back() - active_cost_[at(last)];
    for (auto i = first; i < last; ++i) sum += cost(rest_ + spread_over(i, excess), i);
    return -sum;
  }

 private:
  [[nodiscard]] std::int64_t size_() const { return std::ssize(power_); }
  [[nodiscard]] double cost(double mean, std::int64_t i) const {
    return 0.5 * freedom_ * (std::log(mean) + power_[at(i)] / mean);
  }
  template <typename F>
  [[nodiscard]] double spread_over(std::int64_t i, const F& excess) const {
    double sum = 0.0;
    for (std::int64_t lag = -reach_; lag <= reach_; ++lag) sum += spread_[at(lag + reach_)] * excess(i - lag);
    return sum;
  }

  double rest_, freedom_;
  const std::vector<double>& spread_;
  std::int64_t reach_;
  std::vector<double> power_, excess_, quiet_cost_, active_cost_;
};

// Of one shape at one edge: instants and their likelihood summed up, from 0 to 1.
struct Instants {
  double step = 0.0;
  std::vector<double> cumulated;
  double evidence = -std::numeric_limits<double>::infinity();
};

Instants instants_of(const Surroundings& around, const Rise& rise) {
  Instants out{.step = rise.step()};
  std::vector<double> log;
  for (double t = 0.0; t + rise.bins <= around.last_instant(); t += out.step)
    log.push_back(around.likelihood(t, rise));
  if (log.empty()) return out;
  const double most = std::ranges::max(log);
  double sum = 0.0;
  for (const double l : log) out.cumulated.push_back(sum += std::exp(l - most));
  for (double& c : out.cumulated) c /= sum;
  out.evidence = most + std::log(sum * out.step);
  return out;
}

}  // namespace

std::vector<std::vector<double>> draw_edges(const std::vector<BurstEdge>& edges,
                                            const std::vector<double>& power,
                                            const std::vector<double>& levels, double rest, double freedom,
                                            const std::vector<double>& spread, double bin_s,
                                            std::int64_t draws, std::uint64_t seed) {
  const auto shapes = rises(bin_s);
  std::vector<std::vector<Instants>> of_edge;
  std::vector<double> evidence(shapes.size(), 0.0);
  for (const auto& edge : edges) {
    const Surroundings around(edge, power, levels, rest, freedom, spread);
    auto& all = of_edge.emplace_back();
    for (const auto& rise : shapes) all.push_back(instants_of(around, rise));
    // A rise that has no room at this edge is no worse here than the shortest.
    for (std::size_t k = 0; k < shapes.size(); ++k)
      evidence[k] += std::isfinite(all[k].evidence) ? all[k].evidence : all.front().evidence - 1.0;
  }
  const double count = static_cast<double>(edges.size());
  const double share = std::min(1.0, kEvidence / count), most = std::ranges::max(evidence);
  double sum = 0.0;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    sum += (k == 0 ? kStepWeight : 1.0) * std::exp(share * (evidence[k] - most));
    evidence[k] = sum;
  }
  Random random(seed, 77);
  std::vector<std::vector<double>> out(at(draws));
  for (auto& draw : out) {
    const double u = sum * random.uniform();
    const auto shape =
        std::min(shapes.size() - 1,
                 static_cast<std::size_t>(std::ranges::upper_bound(evidence, u) - evidence.begin()));
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& edge = edges[e];
      const auto& all = of_edge[e];
      const auto& one = all[shape].cumulated.empty() ? all.front() : all[shape];
      const auto place = std::ranges::lower_bound(one.cumulated, random.uniform()) - one.cumulated.begin();
      const double instant =
          (static_cast<double>(std::min(place, std::ssize(one.cumulated) - 1)) + random.uniform() - 0.5) *
              one.step +
          kWithinBin * random.gaussian();
      const double bin = static_cast<double>(edge.bin), quiet = static_cast<double>(edge.quiet);
      draw.push_back(edge.is_onset ? bin - quiet + instant : bin + quiet - instant);
    }
  }
  return out;
}

}  // namespace kinemark::analysis

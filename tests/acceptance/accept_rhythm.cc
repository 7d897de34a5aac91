// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events and cycles of simulated movements: whether their deviations and intervals cover the truth, and
// whether movements without a period get no cycles. Arguments: movements of each family (default 200), first
// seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "acceptance/path_families.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/analysis/path/rhythm.h"
#include "kinemark/stages/analysis/path/timing.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr std::array kFamilies{"reach", "submovements", "reaches", "ellipse",
                               "eight", "sign",         "walk",    "aimless"};

// Out and back between two places, three to five times, with rests of 0.3 to 0.8 s.
analysis::PathSamples reaches(double rate_hz, Random& random) {
  const int count = 6 + 2 * std::min(2, static_cast<int>(random.uniform(0.0, 3.0)));
  const double way_m = random.uniform(0.1, 0.5);
  const Eigen::Vector3d to =
      way_m * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
  std::vector<std::pair<double, double>> ways;  // begin, duration
  double begin_s = random.uniform(0.4, 0.8);
  for (int k = 0; k < count; ++k) {
    ways.emplace_back(begin_s, random.uniform(0.5, 1.0));
    begin_s += ways.back().second + random.uniform(0.3, 0.8);
  }
  const auto n = static_cast<std::int64_t>((begin_s + 0.3) * rate_hz);
  analysis::PathSamples out{.rate_hz = rate_hz};
  for (auto* part : {&out.x, &out.v, &out.a, &out.j}) part->setZero(n, 3);
  for (std::int64_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const double u =
          std::clamp((static_cast<double>(i) / rate_hz - ways[k].first) / ways[k].second, 0.0, 1.0);
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      out.x.row(i) += sign * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) * to.transpose();
      out.v.row(i) += sign * 30.0 * u * u * (1.0 - u) * (1.0 - u) / ways[k].second * to.transpose();
      out.a.row(i) +=
          sign * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / std::pow(ways[k].second, 2) * to.transpose();
    }
  return out;
}

// A path without a period: three sums of thirty sines of random frequencies of 0.2 to 2 Hz, 8 s.
analysis::PathSamples aimless(double rate_hz, Random& random) {
  struct Sine {
    double size_m, w, phase;
  };
  std::array<std::vector<Sine>, 3> sines;
  for (auto& axis : sines)
    for (int k = 0; k < 30; ++k) {
      const double hz = random.uniform(0.2, 2.0);
      axis.push_back(
          {0.03 * random.gaussian() / hz, 6.283185307179586 * hz, random.uniform(0.0, 6.283185307179586)});
    }
  const auto n = static_cast<std::int64_t>(8.0 * rate_hz);
  analysis::PathSamples out{.rate_hz = rate_hz};
  for (auto* part : {&out.x, &out.v, &out.a, &out.j}) part->setZero(n, 3);
  for (std::int64_t i = 0; i < n; ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const auto& [size_m, w, phase] : sines[static_cast<std::size_t>(axis)]) {
        const double t = static_cast<double>(i) / rate_hz;
        out.x(i, axis) += size_m * std::sin(w * t + phase);
        out.v(i, axis) += size_m * w * std::cos(w * t + phase);
        out.a(i, axis) -= size_m * w * w * std::sin(w * t + phase);
      }
  return out;
}

data::Trajectories recording_of(const analysis::PathSamples& path, double noise_mm, Random& random) {
  const auto n = path.count();
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = path.rate_hz, .frames = n});
  const bool gap = random.uniform() < 0.5;
  const auto length = static_cast<std::int64_t>(random.uniform(0.03, 0.1) * path.rate_hz) + 1;
  const auto first = static_cast<std::int64_t>(
      random.uniform(0.12 * path.rate_hz, static_cast<double>(n - length) - 0.12 * path.rate_hz));
  for (std::int64_t i = 0; i < n; ++i) {
    const Eigen::Vector3d noise =
        1e-3 * noise_mm * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    if (gap && i >= first && i < first + length) continue;
    out.x(i, 0) = path.x.row(i).transpose() + noise;
    out.state[out.index(i, 0)] = data::SampleState::measured;
  }
  return out;
}

// Counts of one kind of movement.
struct Counts {
  int movements = 0, periodic = 0;
  int events = 0, covered = 0, invented = 0, missed = 0, without_sd = 0;
  int cycle_events = 0, cycle_covered = 0;
  int durations = 0, durations_covered = 0, variations = 0, variations_covered = 0;
  double widths_s = 0.0;

  void add(const Counts& o) {
    movements += o.movements, periodic += o.periodic, events += o.events, covered += o.covered,
        invented += o.invented;
    missed += o.missed, without_sd += o.without_sd, cycle_events += o.cycle_events,
        cycle_covered += o.cycle_covered;
    durations += o.durations, durations_covered += o.durations_covered, variations += o.variations;
    variations_covered += o.variations_covered, widths_s += o.widths_s;
  }
};

// The nearest of the times; none beyond 0.2 s.
std::optional<double> nearest(const std::vector<double>& times, double to) {
  std::optional<double> best;
  for (const double t : times)
    if (std::abs(t - to) < (best ? std::abs(*best - to) : 0.2)) best = t;
  return best;
}

bool holds(const data::Interval& interval, double truth) {
  return !(truth < interval.low) && !(truth > interval.high);
}

// The truth is the same definition, without noise, on the samples that were measured.
Counts judge(const analysis::PathSamples& path, const analysis::PathRhythm& found) {
  Counts out{.movements = 1, .periodic = found.periodic};
  const auto first = std::llround(found.start_s * path.rate_hz),
             last = std::llround(found.end_s * path.rate_hz);
  const auto count = last - first + 1;
  const analysis::PathSamples span{.rate_hz = path.rate_hz,
                                   .x = path.x.middleRows(first, count),
                                   .v = path.v.middleRows(first, count),
                                   .a = path.a.middleRows(first, count),
                                   .j = path.j.middleRows(first, count)};
  const analysis::SeriesMatrix x = span.x;
  std::array<std::vector<double>, 3> truth;
  for (const auto& movement : analysis::movements_of(span, analysis::speed_of(span))) {
    if (std::isfinite(movement.onset_s)) truth[0].push_back(found.start_s + movement.onset_s);
    if (std::isfinite(movement.end_s)) truth[1].push_back(found.start_s + movement.end_s);
  }
  Eigen::Vector3d axis = analysis::detrended_axis(x);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  if (axis[largest] < 0.0) axis = -axis;
  for (const double t : analysis::cycle_starts(x, axis, path.rate_hz, analysis::CycleTrend::of_whole_cycles))
    truth[2].push_back(found.start_s + t);
  std::array<int, 2> seen{};
  for (const auto& event : found.events) {
    const auto kind = static_cast<std::size_t>(event.kind);
    const auto true_s = nearest(truth[kind], event.time_s);
    if (kind < 2) ++seen[kind];
    if (!true_s) {
      ++out.invented;
      continue;
    }
    if (!std::isfinite(event.sd_s)) {
      ++out.without_sd;
      continue;
    }
    const bool covers = std::abs(event.time_s - *true_s) <= 1.96 * event.sd_s;
    ++(kind < 2 ? out.events : out.cycle_events);
    (kind < 2 ? out.covered : out.cycle_covered) += covers;
    if (kind < 2) out.widths_s += event.sd_s;
  }
  for (const std::size_t kind : {0u, 1u})
    out.missed += std::max(0, static_cast<int>(truth[kind].size()) - seen[kind]);
  std::vector<double> lengths;
  for (const auto& measure : found.measures) {
    if (measure.id != "cycle_duration" || measure.interval.kind != data::IntervalKind::two_sided) continue;
    const auto begin = nearest(truth[2], measure.start_s), end = nearest(truth[2], measure.end_s);
    if (!begin || !end) continue;
    lengths.push_back(*end - *begin);
    ++out.durations;
    out.durations_covered += holds(measure.interval, lengths.back());
  }
  const auto variation = std::ranges::find(found.measures, "cycle_variation", &data::Measure::id);
  if (variation != found.measures.end() && variation->interval.kind != data::IntervalKind::none &&
      lengths.size() > 1) {
    double mean = 0.0, squares = 0.0;
    for (const double s : lengths) mean += s / static_cast<double>(lengths.size());
    for (const double s : lengths) squares += (s - mean) * (s - mean);
    ++out.variations;
    out.variations_covered +=
        holds(variation->interval, std::sqrt(squares / static_cast<double>(lengths.size() - 1)) / mean);
  }
  return out;
}

Counts measure_one(const std::string& family, std::uint64_t seed) {
  Random random(seed, 9);
  constexpr std::array kRates{60.0, 100.0, 120.0, 240.0};
  const double rate = kRates[std::min<std::size_t>(3, static_cast<std::size_t>(random.uniform(0.0, 4.0)))];
  const double noise_mm = std::exp(random.uniform(std::log(0.1), std::log(3.0)));
  const auto path = family == "reaches" ? reaches(rate, random)
                    : family == "aimless"
                        ? aimless(rate, random)
                        : acceptance::sample_movement(acceptance::draw_movement(family, random), rate);
  const auto markers = recording_of(path, noise_mm, random);
  const auto measured = analysis::measure_paths(markers, {.measures = {"cycle_duration", "cycle_variation"},
                                                          .noise_sd_m = 1e-3 * noise_mm,
                                                          .seed = seed,
                                                          .rhythms = true});
  if (!measured || measured->rhythms.empty()) return {};
  return judge(path, measured->rhythms.front());
}

double per_cent(int part, int of) { return 100.0 * part / std::max(1, of); }

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::array<Counts, kFamilies.size()> all;
  std::mutex mutex;
  parallel_for(static_cast<std::int64_t>(kFamilies.size()) * count, 1, 0,
               [&](std::int64_t begin, std::int64_t end) {
                 for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
                   const auto family = i % kFamilies.size();
                   const auto one = measure_one(kFamilies[family], first_seed + i);
                   const std::lock_guard lock(mutex);
                   all[family].add(one);
                 }
               });
  Counts discrete, cyclic;
  for (std::size_t f = 0; f < 3; ++f) discrete.add(all[f]);
  for (std::size_t f = 3; f < 7; ++f) cyclic.add(all[f]);
  for (std::size_t f = 0; f < 3; ++f) {
    const auto& c = all[f];
    print_row(per_cent(c.covered, c.events) >= 91.0,
              fmt::format("rhythm, {}: starts and ends within 1.96 SD", kFamilies[f]), "91 %",
              fmt::format("{:.1f} % of {}, SD {:.1f} ms", per_cent(c.covered, c.events), c.events,
                          1e3 * c.widths_s / std::max(1, c.events)));
  }
  const int truths = discrete.events + discrete.without_sd + discrete.missed;
  print_row(
      per_cent(discrete.missed + discrete.invented + discrete.without_sd, truths) <= 5.0,
      "rhythm, discrete: starts and ends missed, invented or without a SD", "5 %",
      fmt::format("{}, {} and {} of {}", discrete.missed, discrete.invented, discrete.without_sd, truths));
  for (std::size_t f = 3; f < 7; ++f) {
    const auto& c = all[f];
    print_row(per_cent(c.periodic, c.movements) >= 97.0,
              fmt::format("rhythm, {}: recognised as periodic", kFamilies[f]), "97 %",
              fmt::format("{} of {}", c.periodic, c.movements));
  }
  print_row(per_cent(cyclic.cycle_covered, cyclic.cycle_events) >= 91.0,
            "rhythm, cyclic: cycle starts within 1.96 SD", "91 %",
            fmt::format("{:.1f} % of {}", per_cent(cyclic.cycle_covered, cyclic.cycle_events),
                        cyclic.cycle_events));
  print_row(
      per_cent(cyclic.durations_covered, cyclic.durations) >= 91.0 &&
          per_cent(cyclic.durations_covered, cyclic.durations) <= 98.0,
      "rhythm, cyclic: duration of one cycle, coverage", "91 to 98 %",
      fmt::format("{:.1f} % of {}", per_cent(cyclic.durations_covered, cyclic.durations), cyclic.durations));
  print_row(per_cent(cyclic.variations_covered, cyclic.variations) >= 91.0,
            "rhythm, cyclic: variation of the cycles, coverage", "91 %",
            fmt::format("{:.1f} % of {}", per_cent(cyclic.variations_covered, cyclic.variations),
                        cyclic.variations));
  const auto& none = all[7];
  print_row(per_cent(none.periodic, none.movements) <= 5.0, "rhythm, paths without a period that get cycles",
            "5 %", fmt::format("{} of {}", none.periodic, none.movements));
  print_row(per_cent(all[0].periodic + all[1].periodic, all[0].movements + all[1].movements) <= 2.0,
            "rhythm, single reaches that get cycles", "2 %",
            fmt::format("{} of {}", all[0].periodic + all[1].periodic, all[0].movements + all[1].movements));
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("rhythm", run);

}  // namespace

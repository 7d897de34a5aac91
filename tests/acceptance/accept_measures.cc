// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of simulated movements: bias against the raw value's, and coverage of the intervals.
// Arguments: movements of each family (default 200), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "acceptance/path_families.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

// One measure of one movement beside its truth.
struct Told {
  std::string family;
  bool periodic = false, discrete = false;
  double truth = kNaN, raw = kNaN, sd = kNaN;
  data::Measure measure;
};

data::Trajectories recording_of(const analysis::PathSamples& path, double noise_mm, Random& random) {
  const auto n = path.count();
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = path.rate_hz, .frames = n});
  std::vector<bool> seen(static_cast<std::size_t>(n), true);
  if (random.uniform() < 0.5) {
    const int gaps = 1 + std::min(2, static_cast<int>(random.uniform(0.0, 3.0)));
    for (int g = 0; g < gaps; ++g) {
      const auto length = static_cast<std::int64_t>(random.uniform(0.03, 0.1) * path.rate_hz) + 1;
      const auto first = static_cast<std::int64_t>(random.uniform(
          0.12 * path.rate_hz, static_cast<double>(n) - 0.12 * path.rate_hz - static_cast<double>(length)));
      for (std::int64_t i = first; i < first + length; ++i) seen[static_cast<std::size_t>(i)] = false;
    }
  }
  for (std::int64_t i = 0; i < n; ++i) {
    const Eigen::Vector3d noise =
        1e-3 * noise_mm * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    if (!seen[static_cast<std::size_t>(i)]) continue;
    out.x(i, 0) = path.x.row(i).transpose() + noise;
    out.state[out.index(i, 0)] = data::SampleState::measured;
  }
  return out;
}

// The samples as recorded, straight across gaps, and central differences: what people compute.
analysis::PathSamples raw_of(const data::Trajectories& markers) {
  analysis::SeriesMatrix x(markers.frames(), 3);
  std::int64_t before = -1;
  for (std::int64_t i = 0; i < markers.frames(); ++i) {
    if (!markers.present(i, 0)) continue;
    x.row(i) = markers.x(i, 0).transpose();
    for (std::int64_t k = before + 1; k < i; ++k)
      x.row(k) = x.row(before) + (x.row(i) - x.row(before)) * static_cast<double>(k - before) /
                                     static_cast<double>(i - before);
    before = i;
  }
  const auto slope = [&](const analysis::SeriesMatrix& of) {
    analysis::SeriesMatrix out = analysis::SeriesMatrix::Zero(of.rows(), 3);
    for (std::int64_t i = 1; i + 1 < of.rows(); ++i)
      out.row(i) = 0.5 * markers.time.rate_hz * (of.row(i + 1) - of.row(i - 1));
    return out;
  };
  analysis::PathSamples out{.rate_hz = markers.time.rate_hz, .x = x};
  out.v = slope(out.x), out.a = slope(out.v), out.j = slope(out.a);
  return out;
}

analysis::PathSamples stretch_of(const analysis::PathSamples& path, std::int64_t first, std::int64_t count) {
  return {.rate_hz = path.rate_hz,
          .x = path.x.middleRows(first, count),
          .v = path.v.middleRows(first, count),
          .a = path.a.middleRows(first, count),
          .j = path.j.middleRows(first, count)};
}

std::vector<Told> tell(const std::string& family, std::uint64_t seed) {
  Random random(seed, 7);
  const auto movement = acceptance::draw_movement(family, random);
  constexpr std::array kRates{60.0, 100.0, 120.0, 240.0};
  const double rate = kRates[std::min<std::size_t>(3, static_cast<std::size_t>(random.uniform(0.0, 4.0)))];
  const double noise_mm = std::exp(random.uniform(std::log(0.1), std::log(3.0)));
  const auto path = acceptance::sample_movement(movement, rate);
  const auto markers = recording_of(path, noise_mm, random);
  const auto measured = analysis::measure_paths(markers, {.noise_sd_m = 1e-3 * noise_mm, .seed = seed});
  std::vector<Told> out;
  if (!measured || measured->measures.empty()) return out;
  const auto& one = measured->measures.front();
  const auto first = std::llround(one.start_s * rate), last = std::llround(one.end_s * rate);
  const auto whole = stretch_of(path, first, last - first + 1);
  const auto raw = stretch_of(raw_of(markers), first, last - first + 1);
  auto frame = analysis::recognise(whole);
  frame.start_s = one.start_s;
  const analysis::PathFacts truth(whole, frame), as_recorded(raw, frame);
  for (const auto& measure : measured->measures)
    for (const auto& definition : analysis::path_definitions())
      if (definition.what.id == measure.id)
        out.push_back({.family = family,
                       .periodic = frame.periodic,
                       .discrete = frame.discrete,
                       .truth = definition.value(truth),
                       .raw = definition.value(as_recorded),
                       .measure = measure});
  return out;
}

struct Count {
  int told = 0, with_interval = 0, one_sided = 0, covered = 0, below_high = 0;
  double bias = 0.0, raw_bias = 0.0, squares = 0.0;
};

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<std::vector<Told>> told(acceptance::kFamilies.size() * static_cast<std::size_t>(count));
  parallel_for(static_cast<std::int64_t>(told.size()), 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const auto family = static_cast<std::size_t>(i) % acceptance::kFamilies.size();
      told[static_cast<std::size_t>(i)] =
          tell(acceptance::kFamilies[family], first_seed + static_cast<std::uint64_t>(i));
    }
  });
  std::map<std::string, std::map<std::string, Count>> table;
  for (const auto& movement : told)
    for (const auto& one : movement) {
      auto& c = table[one.measure.id][one.family];
      ++c.told;
      if (!std::isfinite(one.measure.value) || !std::isfinite(one.truth)) continue;
      const auto& interval = one.measure.interval;
      c.bias += one.measure.value - one.truth, c.raw_bias += one.raw - one.truth;
      c.squares += (one.measure.value - one.truth) * (one.measure.value - one.truth);
      if (interval.kind == data::IntervalKind::none) continue;
      ++c.with_interval;
      c.one_sided += interval.kind == data::IntervalKind::at_most;
      c.below_high += one.truth <= interval.high;
      c.covered += one.truth <= interval.high && !(one.truth < interval.low);
    }
  for (const auto& [id, families] : table)
    for (const auto& [family, c] : families)
      fmt::print(
          "{:20} {:13} told {:4} interval {:4} one-sided {:4} covered {:5.1f} % upper {:5.1f} %  bias/raw "
          "{:8.4f} bias/sd {:6.2f}\n",
          id, family, c.told, c.with_interval, c.one_sided, 100.0 * c.covered / std::max(1, c.with_interval),
          100.0 * c.below_high / std::max(1, c.with_interval), c.bias / c.raw_bias,
          c.bias / c.told / std::sqrt(c.squares / c.told));
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("measures", run);

}  // namespace

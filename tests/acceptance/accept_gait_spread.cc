// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Intervals of the SDs between strides and between steps, of walkers whose steps differ by a known amount:
// the SD of the steps that were recorded, which they are for, and that of endlessly many steps, which they
// are not for. Feet move as if each strike erred by 7 ms, as events do. Arguments: walkers of each kind
// (default 40), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "acceptance/uneven_walks.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using data::Side;
using testing_support::print_note;
using testing_support::print_row;

constexpr std::array kKinds{"shifted", "planned"};
constexpr std::array kMeasures{"stride_time_sd", "step_width_sd"};
constexpr double kSame_s = 0.25;  // a strike that was found this near is that of the step

struct Held {
  std::string id;
  bool at_most = false, stated = false;
  double low = 0.0, high = 0.0, value = 0.0, of_these = 0.0, of_all = 0.0;
};

std::int64_t step_at(const std::vector<acceptance::UnevenStep>& steps, double found_s) {
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (std::abs(steps[k].strike_s - found_s) < kSame_s) return static_cast<std::int64_t>(k);
  return -1;
}

/// A cycle that was found gets what is true of its steps. False where it is not from one step to the next.
bool put_truth(const acceptance::UnevenWalk& walk, analysis::GaitCycle& cycle) {
  const auto& steps = walk.steps[data::index_of(cycle.side)];
  const auto& others = walk.steps[data::index_of(data::opposite(cycle.side))];
  const auto from = step_at(steps, cycle.start_s), to = step_at(steps, cycle.end_s),
             between = step_at(others, cycle.other_strike_s);
  if (from < 0 || to != from + 1) return false;
  const auto &first = steps[static_cast<std::size_t>(from)], &last = steps[static_cast<std::size_t>(to)];
  cycle.start_s = first.strike_s;
  cycle.end_s = last.strike_s;
  if (std::isfinite(cycle.print.x.x())) cycle.print.x = first.heel;
  if (std::isfinite(cycle.next_print.x.x())) cycle.next_print.x = last.heel;
  if (!std::isfinite(cycle.other_print.x.x())) return true;
  if (between < 0) return false;
  cycle.other_print.x = others[static_cast<std::size_t>(between)].heel;
  return true;
}

std::vector<Held> walk_one(const std::string& kind, std::uint64_t seed) {
  const auto walk = acceptance::uneven_walk(kind, seed);
  const auto gait = analysis::analyze_gait(
      walk.markers, {}, {.measures = {std::begin(kMeasures), std::end(kMeasures)}, .seed = seed});
  std::vector<Held> out;
  if (!gait) return out;
  for (const auto& measure : gait->measures) {
    const auto& definition = *analysis::find_gait_definition(measure.id);
    std::vector<analysis::GaitCycle> cycles;
    bool same = true;
    for (auto cycle : gait->cycles) {
      if (definition.scope == analysis::GaitScope::each_side &&
          data::to_string(cycle.side) != measure.context)
        continue;
      same = same && put_truth(walk, cycle);
      cycles.push_back(cycle);
    }
    const double of_these = definition.value(cycles);
    if (!same || !std::isfinite(of_these)) continue;
    const bool time = measure.id == "stride_time_sd";
    out.push_back({.id = measure.id,
                   .at_most = measure.interval.kind == data::IntervalKind::at_most,
                   .stated = std::isfinite(measure.interval.high),
                   .low = std::isfinite(measure.interval.low) ? measure.interval.low : 0.0,
                   .high = measure.interval.high,
                   .value = measure.value,
                   .of_these = of_these,
                   .of_all = time ? walk.stride_sd_s : walk.width_sd_m});
  }
  return out;
}

struct Tally {
  int all = 0, stated = 0, at_most = 0, below = 0, above = 0, all_below = 0, all_above = 0;
  double squares = 0.0, halves = 0.0;
  void add(const Held& one) {
    ++all;
    if (!one.stated) return;
    ++stated, at_most += one.at_most;
    below += one.of_these<one.low, above += one.of_these> one.high;
    all_below += one.of_all<one.low, all_above += one.of_all> one.high;
    squares += (one.value - one.of_these) * (one.value - one.of_these);
    halves += 0.25 * (one.high - one.low) * (one.high - one.low);
  }
  [[nodiscard]] double percent(int out) const { return 100.0 * (stated - out) / std::max(1, stated); }
};

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 40;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  for (const std::string kind : kKinds) {
    std::vector<std::vector<Held>> walkers(static_cast<std::size_t>(count));
    parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = begin; i < end; ++i)
        walkers[static_cast<std::size_t>(i)] = walk_one(kind, first_seed + static_cast<std::uint64_t>(i));
    });
    std::map<std::string, Tally> tallies;
    for (const auto& walker : walkers)
      for (const auto& one : walker) tallies[one.id].add(one);
    for (const std::string id : kMeasures) {
      const auto& one = tallies[id];
      const auto name = fmt::format("gait_spread, {} walkers, {}", kind, id);
      const double held = one.percent(one.below + one.above);
      print_row(one.stated > 0 && held >= 91.0, name + ", 95 % interval of the steps recorded", ">= 91 %",
                fmt::format("{:.1f} % of {}, {} below and {} above, {} at most; error {:.3g} RMS, half an "
                            "interval {:.3g}",
                            held, one.stated, one.below, one.above, one.at_most,
                            std::sqrt(one.squares / std::max(1, one.stated)),
                            std::sqrt(one.halves / std::max(1, one.stated))));
      print_note(name + ", of endlessly many steps", fmt::format("{:.1f} % of {}, {} below and {} above",
                                                                 one.percent(one.all_below + one.all_above),
                                                                 one.stated, one.all_below, one.all_above));
      print_row(one.all >= count / 2 && one.stated >= 0.95 * one.all, name + ", intervals stated", ">= 95 %",
                fmt::format("{} of {}", one.stated, one.all));
    }
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("gait_spread", run);

}  // namespace

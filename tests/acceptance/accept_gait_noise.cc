// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Intervals of stride measures of simulated walkers whose markers have noise of three colours. All strides of
// a walker are alike, and detectors of events err by little there: the own error of each event, which
// intervals hold as laboratories differ by it, is put on the walker's true instants. Arguments: walkers of
// each colour (default 40), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/noise_kinds.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using analysis::testing::KnownWalk;
using data::Side;
using testing_support::print_row;

constexpr std::array kColours{"white", "ar0.9", "butterworth"};
constexpr std::array kMeasures{"step_length", "step_width",  "stride_length",
                               "gait_speed",  "stride_time", "step_time"};
constexpr double kOwnError_s = 0.007;  // of an event: docs/theory/gait.md

/// What one measure of one walker came to.
struct Held {
  std::string id;
  bool stated = false, below = false, above = false;  // has an interval; truth below or above it
  double error = 0.0, half = 0.0;                     // value less truth, half the interval
};

/// A walker's true instants, each strike with its own error.
class Truth {
 public:
  Truth(const KnownWalk& walk, std::uint64_t seed) : walk_(walk), seed_(seed) {}

  [[nodiscard]] double value(const std::string& id, Side side,
                             const std::vector<analysis::GaitCycle>& cycles) const {
    if (id == "step_length") return step_share(side) * walk_.stride_m();
    if (id == "step_width") return walk_.width_m;
    if (id == "stride_length") return walk_.stride_m();
    double way = 0.0, time = 0.0, count = 0.0, steps = 0.0;
    for (const auto& cycle : cycles) {
      const double duration = strike(cycle.side, cycle.end_s) - strike(cycle.side, cycle.start_s);
      const auto other = data::opposite(cycle.side);
      if (id == "gait_speed" && std::isfinite(cycle.stride_length())) {
        way += walk_.stride_m(), time += duration;
      } else if (id == "stride_time" && cycle.side == side) {
        time += duration, count += 1.0;
      } else if (id == "step_time" && other == side && std::isfinite(cycle.other_strike_s)) {
        steps += strike(other, cycle.other_strike_s) - strike(cycle.side, cycle.start_s), count += 1.0;
      }
    }
    return id == "gait_speed" ? way / time : (id == "stride_time" ? time : steps) / count;
  }

 private:
  [[nodiscard]] double step_share(Side side) const {
    return side == Side::right ? walk_.right_later : 1.0 - walk_.right_later;
  }
  /// The true instant of the strike that was found there.
  [[nodiscard]] double strike(Side side, double found_s) const {
    const auto step = std::llround((found_s - walk_.strike_s(side, 0)) / walk_.stride_s);
    Random random(seed_, 4 * static_cast<std::uint64_t>(step + 100) + data::index_of(side));
    return walk_.strike_s(side, step) + kOwnError_s * random.gaussian();
  }

  const KnownWalk& walk_;
  std::uint64_t seed_;
};

data::Trajectories noisy_markers(const KnownWalk& walk, const std::string& colour, Random& random) {
  auto out = walk.markers(0.0, 1);
  const double usual_m = 1e-3 * std::exp(random.uniform(std::log(0.1), std::log(1.0)));
  const double cutoff = acceptance::draw_cutoff(walk.rate_hz, random);
  for (std::int64_t m = 0; m < out.markers(); ++m) {
    math::SeriesMatrix x(out.frames(), 3);
    for (std::int64_t f = 0; f < out.frames(); ++f) x.row(f) = out.x(f, m).transpose();
    const double sd = usual_m * std::exp(0.3 * random.gaussian());
    x = acceptance::with_noise_of_colour(colour, x, sd, random);
    if (acceptance::is_filtered(colour)) acceptance::low_pass(colour, cutoff, walk.rate_hz, x);
    for (std::int64_t f = 0; f < out.frames(); ++f) out.x(f, m) = x.row(f).transpose();
  }
  return out;
}

std::vector<Held> walk_one(const std::string& colour, std::uint64_t seed) {
  Random random(seed, 13);
  auto walk = KnownWalk::draw(random);
  constexpr std::array kRates{100.0, 120.0, 200.0};
  walk.rate_hz = kRates[std::min<std::size_t>(2, static_cast<std::size_t>(random.uniform(0.0, 3.0)))];
  walk.treadmill = seed % 2 == 0;
  walk.duration_s = walk.treadmill ? 12.0 : random.uniform(3.5, 6.0);
  const auto gait = analysis::analyze_gait(noisy_markers(walk, colour, random), {}, {.seed = seed});
  std::vector<Held> out;
  if (!gait) return out;
  const Truth truth(walk, seed);
  for (const auto& measure : gait->measures) {
    if (std::ranges::find(kMeasures, measure.id) == kMeasures.end()) continue;
    const double true_value =
        truth.value(measure.id, measure.context == "Right" ? Side::right : Side::left, gait->cycles);
    out.push_back({.id = measure.id,
                   .stated = std::isfinite(measure.interval.low) && std::isfinite(measure.interval.high),
                   .below = true_value<measure.interval.low, .above = true_value> measure.interval.high,
                   .error = measure.value - true_value,
                   .half = 0.5 * (measure.interval.high - measure.interval.low)});
  }
  return out;
}

struct Tally {
  int all = 0, stated = 0, below = 0, above = 0;
  double squares = 0.0, halves = 0.0;
  void add(const Held& one) {
    ++all;
    if (!one.stated) return;
    ++stated, below += one.below, above += one.above;
    squares += one.error * one.error, halves += one.half * one.half;
  }
  [[nodiscard]] double percent() const { return 100.0 * (stated - below - above) / std::max(1, stated); }
  [[nodiscard]] std::string words() const {
    return fmt::format("{:.1f} % of {}, {} below and {} above", percent(), stated, below, above);
  }
};

int run_colours(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 40;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  for (const std::string colour : kColours) {
    std::vector<std::vector<Held>> walkers(static_cast<std::size_t>(count));
    parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = begin; i < end; ++i)
        walkers[static_cast<std::size_t>(i)] = walk_one(colour, first_seed + static_cast<std::uint64_t>(i));
    });
    std::map<std::string, Tally> by_measure;
    Tally all;
    for (const auto& walker : walkers)
      for (const auto& one : walker) all.add(one), by_measure[one.id].add(one);
    const auto name = fmt::format("gait_noise, {} noise", colour);
    print_row(all.stated > 0 && all.percent() >= 91.0 && all.percent() <= 98.0,
              name + ", all stride measures, 95 % intervals", "91-98 %", all.words());
    print_row(all.stated >= 0.95 * all.all && all.all > 0, name + ", intervals stated", ">= 95 %",
              fmt::format("{} of {}", all.stated, all.all));
    for (const std::string id : kMeasures) {
      const auto& one = by_measure[id];
      print_row(one.stated > 0 && one.percent() >= 85.0, fmt::format("{}, {}", name, id), ">= 85 %",
                fmt::format("{}, error {:.3g} RMS, half an interval {:.3g}", one.words(),
                            std::sqrt(one.squares / std::max(1, one.stated)),
                            std::sqrt(one.halves / std::max(1, one.stated))));
    }
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("gait_noise", run_colours);

}  // namespace

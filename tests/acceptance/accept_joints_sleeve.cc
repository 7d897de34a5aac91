// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The macaque's sleeve of 16 LEDs at 60 Hz with dropout that depends on the pose: every frame by itself
// against the Cramer-Rao bound, then with continuity. Arguments: the number of seeds, then the parts to run.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "acceptance/joint_cells.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using joint_cells::Tally;
using testing_support::print_row;

constexpr double kMm = 1e-3;

struct Run {
  int seeds = 10;
  double duration_s = 30.0;
  bool quick = false;
};

Tally run_sleeve(simulation::SleeveOptions sleeve, const Run& run, double noise_mm, bool continuity) {
  skeleton::ArticulatedOptions options;
  options.continuity = continuity;
  Tally tally;
  for (int seed = 1; seed <= run.seeds; ++seed) {
    sleeve.duration_s = run.duration_s;
    sleeve.noise_sd_m = noise_mm * kMm;
    sleeve.seed = static_cast<std::uint64_t>(seed);
    joint_cells::measure(simulation::simulate_sleeve(sleeve).value(), data::SegmentKind::solid,
                         sleeve.noise_sd_m, options, tally);
  }
  return tally;
}

void frame_by_frame(const Run& run) {
  Tally all;
  for (const double noise : {0.5, 1.0, 2.0, 3.0}) {
    if (run.quick && noise != 1.0) continue;
    const auto t = run_sleeve({}, run, noise, false);
    print_row(t.ratio() <= (run.quick ? 1.15 : 1.1) && t.worst_seed() <= 1.15 &&
                  t.determined_without_bound == 0 && t.wrong_unflagged == 0,
              fmt::format("sleeve, {} mm, each frame by itself", noise),
              run.quick ? "every seed <= 1.15 x bound; none beyond 5 SD unflagged"
                        : "<= 1.1 x bound, every seed <= 1.15; none beyond 5 SD unflagged",
              t.description());
    all.add(t);
  }
  const double one = Tally::part(all.in_1sd, all.coordinates), two = Tally::part(all.in_2sd, all.coordinates);
  // The geometry's error is common to a recording's frames: one recording is not conclusive about coverage.
  if (!run.quick)
    print_row(one >= 0.60 && one <= 0.75 && two >= 0.91 && two <= 0.985, "sleeve: coverage of centres",
              "60-75 % and 91-98.5 %", fmt::format("{:.1f} and {:.1f} %", 100.0 * one, 100.0 * two));
}

void in_time(const Run& run, const char* what, const simulation::SleeveOptions& sleeve) {
  for (const double noise : {0.5, 1.0, 2.0, 3.0}) {
    if (run.quick && noise != 1.0) continue;
    const auto t = run_sleeve(sleeve, run, noise, true);
    const double determined =
        std::sqrt(t.smooth_squares_m2 / static_cast<double>(std::max<std::int64_t>(t.determined, 1)));
    const double bridged =
        std::sqrt(t.bridged_squares_m2 / static_cast<double>(std::max<std::int64_t>(t.bridged, 1)));
    print_row(t.unanswered == 0 && bridged <= 1.25 * determined && t.wrong == 0,
              fmt::format("{}, {} mm, with continuity", what, noise),
              "every frame answered; flagged RMS <= 1.25 x determined; none beyond 5 SD",
              fmt::format(
                  "{} of {} unanswered; {:.2f} mm in {} bridged, {:.2f} mm in {} determined; {} beyond 5 SD; "
                  "worst {:.1f} mm",
                  t.unanswered, t.frames, bridged / kMm, t.bridged, determined / kMm, t.determined, t.wrong,
                  t.worst_m / kMm));
  }
}

int run_check(int argc, char** argv) {
  Run run;
  if (argc > 1) run.seeds = std::max(1, std::atoi(argv[1]));
  run.quick = run.seeds < 3;
  if (run.quick) run.duration_s = 15.0;
  const std::vector<std::string> parts(argv + std::min(argc, 2), argv + argc);
  const auto wanted = [&](const char* part) {
    return parts.empty() || std::ranges::find(parts, part) != parts.end();
  };
  if (wanted("frames")) frame_by_frame(run);
  if (wanted("time")) {
    in_time(run, "sleeve", {});
    in_time(run, "sleeve, harder sight and 20 % lost", simulation::SleeveOptions::hard());
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("joints_sleeve", run_check);

}  // namespace

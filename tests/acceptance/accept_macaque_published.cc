// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The macaque report's method by the reading that its numbers need, beside these numbers.
// Arguments: recordings of each cell (default 40), first seed (default 1).
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "studies/macaque/published_elbow.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr double kWithin = 0.25;  // of what the report publishes
constexpr double kThreshold_m = 0.030, kShare = 0.40;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double sd_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values) squares += (v - mean_of(values)) * (v - mean_of(values));
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 40;
  std::vector<std::uint64_t> seeds(static_cast<std::size_t>(count));
  std::iota(seeds.begin(), seeds.end(), argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  const auto cells = studies::study_published(seeds, 0).value();
  for (const auto& cell : cells) {
    const auto name = fmt::format("report's method, {:g} mm noise, {:.0f} % missing", 1e3 * cell.cell.noise_m,
                                  100.0 * cell.cell.missing);
    const double mean = mean_of(cell.classic_m);
    const auto measured =
        fmt::format("{:.1f} mm, SD {:.1f} of {} recordings of {}; ours {:.2f} mm", 1e3 * mean,
                    1e3 * sd_of(cell.classic_m), cell.classic_m.size(), count, 1e3 * mean_of(cell.ours_m));
    if (!cell.cell.paper_m)
      testing_support::print_note(name, measured);
    else
      print_row(std::abs(mean / *cell.cell.paper_m - 1.0) <= kWithin, name + ", mean error",
                fmt::format("{:g} mm within 25 %", 1e3 * *cell.cell.paper_m), measured);
  }
  const auto share = studies::share_at(cells, kThreshold_m);
  print_row(share && std::abs(*share / kShare - 1.0) <= kWithin,
            "report's method, share missing at which 30 mm are reached", "40 % within 25 %",
            share ? fmt::format("{:.1f} %", 100.0 * *share) : "not reached");
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("macaque_published", run);

}  // namespace

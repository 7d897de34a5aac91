// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The method of 1986 on rigs as they may have been built, beside what the paper reports.
// Arguments: rigs (default 12), first seed (default 1).
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include "kinemark/core/parallel.h"
#include "kinemark/math/statistics.h"
#include "studies/poizner/as_built_study.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr double kFactor = 1.6;  // of what the paper reports
constexpr int kManyRigs = 40;    // from which 5 and 95 % are not the first and the last

struct Number {
  const char* what;
  double paper, unit;
  std::function<double(const studies::AsBuiltMeasures&)> get;
  bool in_span;  // whether the paper's value lies among the rigs, too
};

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 12;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<Result<studies::AsBuiltOutcome>> rigs(static_cast<std::size_t>(count));
  parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      rigs[static_cast<std::size_t>(i)] = studies::study_as_built(first + static_cast<std::uint64_t>(i));
  });
  std::vector<studies::AsBuiltOutcome> done;
  for (auto& rig : rigs)
    if (rig) done.push_back(std::move(*rig));
  print_row(done.size() == rigs.size(), "rigs of 1986 as built", "all are measured",
            fmt::format("{} of {}", done.size(), rigs.size()));
  const std::vector<Number> numbers{
      {"tree, best place, mm", 2.0, 1e3, [](const auto& m) { return m.best_place_m(); }, true},
      {"tree, worst place, mm", 46.0, 1e3, [](const auto& m) { return m.worst_place_m(); }, true},
      {"wheel, median error, mm", 0.6, 1e3, [](const auto& m) { return std::abs(m.wheel.median_error_m); },
       true},
      {"wheel, scatter, mm", 0.5, 1e3, [](const auto& m) { return m.wheel.sd_m; }, false},
      {"wheel, largest error, mm", 10.0, 1e3, [](const auto& m) { return m.wheel.max_error_m; }, false},
      {"wheel, plane, mm", 1.1, 1e3, [](const auto& m) { return m.wheel.plane_sd_m; }, false},
      {"wheel, ratio of the axes less 1, %", 3.0, 1e2,
       [](const auto& m) { return m.wheel.spread_of_all - 1.0; }, true}};
  std::vector<double> ours;
  for (const auto& number : numbers) {
    std::vector<double> values;
    for (const auto& rig : done) values.push_back(number.unit * number.get(rig.classic));
    const double median = math::median(values), low = math::quantile(values, 0.1),
                 high = math::quantile(values, 0.9),
                 factor = std::exp(std::abs(std::log(median / number.paper)));
    print_row(
        factor <= kFactor, fmt::format("method of 1986 as built: {}", number.what),
        fmt::format("median within a factor of {} of {:g}", kFactor, number.paper),
        fmt::format("a factor of {:.2f}: {:.3g}, 10 to 90 % {:.3g} to {:.3g}", factor, median, low, high));
    if (number.in_span && count >= kManyRigs) {
      const double least = math::quantile(values, 0.05), most = math::quantile(values, 0.95);
      print_row(least <= number.paper && number.paper <= most,
                fmt::format("method of 1986 as built: {}, the paper's among the rigs", number.what),
                fmt::format("{:g} within 5 to 95 %", number.paper),
                fmt::format("{:.3g} to {:.3g}", least, most));
    }
  }
  for (const auto& rig : done) ours.push_back(1e3 * rig.ours.best_place_m());
  print_row(math::median(ours) <= 0.25, "ours on the same rigs, with a dark slot: tree, best place, mm",
            "median at most 0.25", fmt::format("{:.3g}", math::median(ours)));
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("as_built", run);

}  // namespace

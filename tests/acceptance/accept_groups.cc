// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Groups of curves that do not differ: how often a difference is found all the same, and how often bands
// hold. Arguments: sets of each design (default 2000), first seed (default 1).
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/groups/mapping.h"
#include "kinemark/stages/analysis/groups/mean_band.h"
#include "kinemark/stages/analysis/groups/testing/random_curves.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using analysis::Design;
using testing_support::print_row;

constexpr std::int64_t kArrangements = 1000;

struct Null {
  Design design = Design::two_sample;
  std::vector<std::int64_t> sizes;
  double width = 8.0;  // of the curves' bumps, points of 101
};

std::vector<data::CycleCurves> draw(const Null& null, Random& random) {
  std::vector<data::CycleCurves> out;
  for (const auto size : null.sizes)
    out.push_back(analysis::testing::random_curves(random, size, null.width));
  return out;
}

bool finds_a_difference(const Null& null, std::uint64_t seed) {
  Random random(seed, 0);
  const auto groups = draw(null, random);
  const auto mapping =
      analysis::map_curves(groups, {.design = null.design, .arrangements = kArrangements, .seed = seed});
  return mapping && !mapping->spans.empty();
}

bool band_holds(const Null& null, std::uint64_t seed, bool of_one) {
  Random random(seed, 1);
  const auto curves = draw(null, random).front();
  const auto next = analysis::testing::random_curves(random, 1, null.width);
  const auto band = analysis::mean_band(curves, 0.95);
  if (!band) return false;
  for (std::size_t p = 0; p < band->mean.size(); ++p) {
    const double truth = of_one ? next.values[p] : 0.0;
    if (std::abs(band->mean[p] - truth) > (of_one ? band->of_one(p) : band->of_mean(p))) return false;
  }
  return true;
}

template <class Test>
double share(std::int64_t sets, std::uint64_t first_seed, const Test& test) {
  std::vector<char> found(static_cast<std::size_t>(sets));
  parallel_for(sets, 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      found[static_cast<std::size_t>(i)] = test(first_seed + static_cast<std::uint64_t>(i)) ? 1 : 0;
  });
  double sum = 0.0;
  for (const char one : found) sum += one;
  return sum / static_cast<double>(sets);
}

int run(int argc, char** argv) {
  const std::int64_t sets = argc > 1 ? std::atoll(argv[1]) : 2000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::vector<Null> nulls{{Design::one_sample, {12}, 8.0},
                                {Design::paired, {10, 10}, 5.0},
                                {Design::two_sample, {8, 8}, 8.0},
                                {Design::two_sample, {15, 9}, 3.0},
                                {Design::one_way, {8, 7, 9, 8}, 12.0}};
  for (const auto& null : nulls) {
    const double found = share(sets, seed, [&](std::uint64_t s) { return finds_a_difference(null, s); });
    std::string sizes;
    for (const auto size : null.sizes) sizes += fmt::format("{}{}", sizes.empty() ? "" : " + ", size);
    print_row(found >= 0.04 && found <= 0.06,
              fmt::format("{} null sets, {} of {} curves: a difference is found", sets,
                          analysis::to_string(null.design), sizes),
              "4 to 6 %", fmt::format("{:.2f} %", 100.0 * found));
  }
  for (const auto& null : {Null{{}, {8}, 8.0}, Null{{}, {20}, 4.0}})
    for (const bool of_one : {false, true}) {
      const double held = share(sets, seed, [&](std::uint64_t s) { return band_holds(null, s, of_one); });
      print_row(held >= 0.94 && held <= 0.97,
                fmt::format("{} sets of {} curves, bumps {:g} points wide: 95 % band of {} holds everywhere",
                            sets, null.sizes.front(), null.width, of_one ? "a further curve" : "the mean"),
                "94 to 97 %", fmt::format("{:.2f} %", 100.0 * held));
    }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("groups", run);

}  // namespace

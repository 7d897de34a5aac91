// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Coverage of the error bars: simulated subjects with known truth, pooled over coordinates and frames.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/model/model.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;

struct Counts {
  std::int64_t total = 0, one = 0, two = 0;
  void add(double z) {
    ++total;
    one += z <= 1.0;
    two += z <= 2.0;
  }
  [[nodiscard]] double at_one() const {
    return 100.0 * static_cast<double>(one) / static_cast<double>(std::max<std::int64_t>(1, total));
  }
  [[nodiscard]] double at_two() const {
    return 100.0 * static_cast<double>(two) / static_cast<double>(std::max<std::int64_t>(1, total));
  }
};

struct World {
  std::string name;
  double soft_tissue = 0.0, common = 0.0, random_gaps = 0.0, sight_gaps = 0.0;
  double one_low = 63.0, one_high = 73.0, two_low = 92.0, two_high = 98.0;
};

void check(const model::Model& model, const World& world, int subjects) {
  Counts pooled;
  std::vector<Counts> per_coordinate(static_cast<std::size_t>(model.coordinate_count()));
  std::int64_t samples = 0;
  for (int s = 1; s <= subjects; ++s) {
    simulation::SubjectOptions options;
    options.duration_s = 10.0;
    options.rate_hz = 60.0;
    options.seed = static_cast<std::uint64_t>(s);
    options.soft_tissue = world.soft_tissue;
    options.soft_tissue_common = world.common;
    options.dropout_random = world.random_gaps;
    options.dropout_sight = world.sight_gaps;
    const auto subject = simulation::simulate_subject(model, options).value();
    motion::IkOptions ik;
    ik.threads = 0;
    const auto result = motion::solve_ik(model, subject.markers, ik).value();
    for (std::size_t i = 0; i < result.motion.q.size(); ++i) {
      ++samples;
      if (!result.motion.determined[i]) continue;
      const double z = std::abs(result.motion.q[i] - subject.truth.q[i]) / result.motion.q_sd[i];
      pooled.add(z);
      per_coordinate[i % per_coordinate.size()].add(z);
    }
  }
  testing_support::print_row(
      pooled.at_one() >= world.one_low && pooled.at_one() <= world.one_high &&
          pooled.at_two() >= world.two_low && pooled.at_two() <= world.two_high,
      fmt::format("coverage, {} simulated subjects, {}", subjects, world.name),
      fmt::format("{:.0f}-{:.0f} % at 1 SD, {:.0f}-{:.0f} % at 2 SD", world.one_low, world.one_high,
                  world.two_low, world.two_high),
      fmt::format("{:.1f} % and {:.1f} %; {:.1f} % of the samples determined", pooled.at_one(),
                  pooled.at_two(), 100.0 * static_cast<double>(pooled.total) / static_cast<double>(samples)));
  const auto by_one = [](const Counts& a, const Counts& b) { return a.at_one() < b.at_one(); };
  const auto [low, high] = std::minmax_element(per_coordinate.begin(), per_coordinate.end(), by_one);
  const auto name = [&](auto it) {
    return model.description().coordinates[static_cast<std::size_t>(it - per_coordinate.begin())].name;
  };
  testing_support::print_row(
      low->at_one() >= 55.0 && high->at_one() <= 85.0, fmt::format("each coordinate, {}", world.name),
      "55-85 % at 1 SD",
      fmt::format("{:.1f} % ({}) to {:.1f} % ({})", low->at_one(), name(low), high->at_one(), name(high)));
}

/// accept_motion coverage [SHARE]: with one share of the skin's motion that a segment's markers have in
/// common, or 30 and 60 %.
int run_check(int argc, char** argv) {
  constexpr int kSubjects = 20;
  const std::vector<double> shares = argc > 1 ? std::vector{std::stod(argv[1])} : std::vector{0.3, 0.6};
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  check(model, {.name = "1 mm noise"}, kSubjects);
  check(model, {.name = "1 mm noise, 20 % gaps", .random_gaps = 0.1, .sight_gaps = 0.1}, kSubjects);
  for (const double common : shares)
    for (const double gaps : {0.0, 0.1})
      check(model,
            {.name = fmt::format("soft tissue, {:.0f} % common, {:.0f} % gaps", 100 * common, 200 * gaps),
             .soft_tissue = 1.0,
             .common = common,
             .random_gaps = gaps,
             .sight_gaps = gaps,
             .one_low = 63.0,
             .one_high = 75.0,
             .two_low = 92.0,
             .two_high = 97.0},
            kSubjects);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("coverage", run_check);

}  // namespace

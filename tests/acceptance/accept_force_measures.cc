// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Simulated steps and standing on a plate with white noise: ground-reaction and sway measures beside the
// truth. Arguments: recordings (default 40), first seed (default 1).
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

struct Judged {
  std::string id;
  double error, raw;
  int inside;
};

/// A recording with noise, or the same without.
data::Wrenches simulate(std::uint64_t seed, bool stands, bool noisy) {
  Random random(seed, stands ? 31 : 32), noise(seed, 33);
  const double rate_hz = random.uniform() < 0.5 ? 100.0 : 240.0;
  const double weight = random.uniform(500.0, 900.0), step_s = random.uniform(0.55, 0.85);
  const double hump = random.uniform(0.3, 0.45), forwards = random.uniform(0.1, 0.2),
               force_sd = random.uniform(0.5, 3.0);
  const double pressure_sd = 1e-3 * random.uniform(0.1, 0.6);
  std::vector<std::array<double, 4>> sway;  // frequency, phase, along, across
  for (int i = 0; i < 12; ++i) {
    const double hz = 0.1 + 0.12 * i + random.uniform(0.0, 0.1);
    const double size = 0.004 / (1.0 + 8.0 * hz * hz);
    sway.push_back({hz, random.uniform(0.0, kTwoPi), size * random.gaussian(), size * random.gaussian()});
  }
  const auto frames = static_cast<std::int64_t>((stands ? 20.0 : 2.0) * rate_hz);
  data::Wrenches out{.time = {.rate_hz = rate_hz, .frames = frames}, .items = {{.name = "plate 1"}}};
  auto& plate = out.items[0];
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / rate_hz, u = std::numbers::pi * (t - 0.5) / step_s;
    const bool on = u >= 0.0 && u <= std::numbers::pi;
    double load = weight, along = 0.0;
    Eigen::Vector2d x(0.0, on ? 0.25 * (t - 0.5) / step_s : 0.0);
    if (stands) {
      x.setZero();
      for (const auto& s : sway) x += std::cos(kTwoPi * s[0] * t + s[1]) * Eigen::Vector2d(s[2], s[3]);
    } else {
      load = on ? weight * (std::sin(u) + hump * std::sin(3.0 * u)) : 0.0;
      along = on ? -forwards * weight * std::sin(2.0 * u) : 0.0;
    }
    const double force[3] = {0.0, along, load};
    for (const double v : force) plate.force.push_back(v + (noisy ? force_sd * noise.gaussian() : 0.0));
    for (int i = 0; i < 3; ++i) plate.moment.push_back(0.0);
    for (int i = 0; i < 2; ++i) plate.point.push_back(x[i] + (noisy ? pressure_sd * noise.gaussian() : 0.0));
    plate.point.push_back(0.0);
  }
  return out;
}

std::vector<Judged> judge(std::uint64_t seed, bool stands) {
  std::vector<Judged> out;
  const auto truth = analysis::measure_forces(simulate(seed, stands, false), {.refits = 0});
  const auto found = analysis::measure_forces(simulate(seed, stands, true), {.seed = seed});
  if (!truth || !found) return out;
  for (const auto& m : found->measures)
    for (const auto& is : truth->measures)
      if (is.id == m.id && std::isfinite(is.value) && m.interval.kind == data::IntervalKind::two_sided)
        out.push_back({m.id, m.value - is.value, m.uncorrected - is.value,
                       m.interval.low <= is.value && is.value <= m.interval.high});
  return out;
}

int run(int argc, char** argv) {
  const auto count = argc > 1 ? std::atoll(argv[1]) : 40;
  const auto first = argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1;
  std::map<std::string, std::vector<Judged>> by_id;
  for (const bool stands : {false, true}) {
    std::vector<std::vector<Judged>> all(at(count));
    parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
        all[at(k)] = judge(first + static_cast<std::uint64_t>(k), stands);
    });
    for (const auto& one : all)
      for (const auto& judged : one) by_id[judged.id].push_back(judged);
  }
  for (const auto& definition : analysis::force_definitions()) {
    const auto& all = by_id[std::string(definition.what.id)];
    double inside = 0.0, bias = 0.0, squares = 0.0;
    const double n = static_cast<double>(all.size());
    for (const auto& j : all) inside += j.inside, bias += j.error / n, squares += j.error * j.error / n;
    const double sd = std::sqrt(std::max(1e-30, squares - bias * bias));
    inside = 100.0 * inside / n;
    const double least = definition.scope == analysis::ForceScope::sway ? 80.0 : 90.0;
    print_row(all.size() > 10 && inside >= least && std::abs(bias) <= 0.5 * sd + 1e-9,
              fmt::format("plates, simulated: {}", definition.what.id),
              fmt::format("covers {:g} % or more, bias <= 0.5 of its SD", least),
              fmt::format("{:.1f} % of {:.0f}, bias {:.2f} SD", inside, n, bias / sd));
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("force_measures", run);

}  // namespace

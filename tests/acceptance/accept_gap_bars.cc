// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Fills as `clean` makes them, of gaps of known truth in real and simulated recordings, beside the SDs that
// they state. Usage: accept_gap_bars GAPS_PER_CELL [SEED] [list]
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/gap_movements.h"
#include "acceptance/gap_trials.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using namespace kinemark::testing_support;

constexpr std::array kBarLengthsS = {0.1, 0.3, 1.0, 2.0};
constexpr std::int64_t kBarFrames = 2400;
constexpr double kLeastM = 1e-6;

struct BarGap {
  std::size_t trial = 0, length = 0;
  std::int64_t marker = 0, first = 0, frames = 0;
  std::vector<std::int64_t> blocked;
  bool filled = false, leaps = false;
  double worst = 0.0;  // |error| / SD, over frames and axes
  double rms_m = 0.0, sd_m = 0.0;
  double inside_1 = 0.0, inside_2 = 0.0, coordinates = 0.0;
};

/// A recorded marker leaps where its path, from one frame to the next, changes by more than 8 times what is
/// usual in its recording and by 2 mm: one that was exchanged, a phantom or a slip. No fill can know of it.
bool leaps(const data::Trajectories& t, const BarGap& g) {
  const auto turn = [&](std::int64_t f) {
    return (t.x(f - 1, g.marker) - 2.0 * t.x(f, g.marker) + t.x(f + 1, g.marker)).norm();
  };
  std::vector<double> all;
  for (std::int64_t f = 1; f + 1 < t.frames(); ++f)
    if (complete(t, g.marker, f - 1, f + 2)) all.push_back(turn(f));
  const double usual = math::median(all);
  for (std::int64_t f = g.first - 1; f <= g.first + g.frames; ++f)
    if (turn(f) > 8.0 * usual && turn(f) > 0.002) return true;
  return false;
}

void draw_gaps(const GapTrial& trial, std::size_t index, int gaps, std::uint64_t seed,
               std::vector<BarGap>& out) {
  const data::Trajectories& t = trial.markers;
  Random random(seed, 300 + index);
  const auto draw = [&](std::int64_t n) {
    return std::min(n - 1, static_cast<std::int64_t>(random.uniform() * static_cast<double>(n)));
  };
  for (std::size_t l = 0; l < kBarLengthsS.size(); ++l) {
    const std::int64_t frames = std::max<std::int64_t>(2, std::lround(kBarLengthsS[l] * t.time.rate_hz));
    if (t.frames() < 3 * frames) continue;
    int done = 0;
    for (int tries = 0; tries < 20 * gaps && done < gaps; ++tries) {
      BarGap g{.trial = index, .length = l, .frames = frames};
      g.marker = draw(t.markers());
      g.first = 2 + draw(t.frames() - frames - 3);
      const std::int64_t what = draw(3);
      if (!complete(t, g.marker, g.first - 2, g.first + frames + 2)) continue;
      g.blocked = {g.marker};
      if (what > 0) {
        g.blocked = find_segment(t, g.marker);
        if (what == 1) g.blocked.resize((g.blocked.size() + 1) / 2);
      }
      out.push_back(std::move(g));
      ++done;
    }
  }
}

void fill(const GapTrial& trial, BarGap& g) {
  data::Trajectories t = trial.markers;
  for (const std::int64_t m : g.blocked)
    for (std::int64_t i = 0; i < g.frames; ++i) t.set_missing(g.first + i, m);
  const auto result = trajectory::fill_gaps(
      t, {.only = {.marker = g.marker, .first_frame = g.first, .last_frame = g.first + g.frames - 1}});
  if (!result) throw std::runtime_error(trial.file + ": " + result.error().message);
  const data::Trajectories& found = result->trajectories;
  g.filled = found.present(g.first, g.marker);
  if (!g.filled) return;
  g.leaps = leaps(trial.markers, g);
  const std::int64_t rows = std::min<std::int64_t>(24, g.frames);  // each gap counts about the same
  double square = 0.0;
  double variance = 0.0;
  for (std::int64_t i = 0; i < g.frames; ++i) {
    const std::int64_t f = g.first + i;
    const double sd = std::sqrt(found.covariance[6 * found.index(f, g.marker)]);
    const Eigen::Vector3d e = found.x(f, g.marker) - trial.markers.x(f, g.marker);
    square += e.squaredNorm();
    variance += 3.0 * sd * sd;
    g.worst = std::max(g.worst, e.cwiseAbs().maxCoeff() / sd);
  }
  g.rms_m = std::sqrt(square / static_cast<double>(g.frames));
  g.sd_m = std::sqrt(variance / static_cast<double>(g.frames));
  for (std::int64_t r = 0; r < rows; ++r) {
    const std::int64_t f = g.first + (rows == 1 ? 0 : r * (g.frames - 1) / (rows - 1));
    const double sd = std::sqrt(found.covariance[6 * found.index(f, g.marker)]);
    for (int axis = 0; axis < 3; ++axis) {
      const double z = std::abs(found.x(f, g.marker)(axis) - trial.markers.x(f, g.marker)(axis)) / sd;
      g.inside_1 += z < 1.0 ? 1.0 : 0.0;
      g.inside_2 += z < 2.0 ? 1.0 : 0.0;
      g.coordinates += 1.0;
    }
  }
}

template <class Belongs>
void judge(const std::vector<BarGap>& gaps, const std::vector<GapTrial>& trials, const std::string& what,
           Belongs belongs) {
  double one = 0.0, two = 0.0, n = 0.0, worst = 0.0, log_error = 0.0, log_sd = 0.0;
  int filled = 0, open = 0, beyond = 0, leaping = 0;
  std::string where;
  for (const BarGap& g : gaps) {
    if (!belongs(g)) continue;
    if (!g.filled) {
      ++open;
      continue;
    }
    ++filled;
    one += g.inside_1;
    two += g.inside_2;
    n += g.coordinates;
    log_error += std::log(g.rms_m + kLeastM);
    log_sd += std::log(g.sd_m + kLeastM);
    if (g.leaps) {
      leaping += g.worst > 6.0 ? 1 : 0;
      continue;
    }
    beyond += g.worst > 6.0 ? 1 : 0;
    if (g.worst > worst) {
      worst = g.worst;
      where = trials[g.trial].file;
    }
  }
  print_row(one >= 0.62 * n && one <= 0.78 * n && two >= 0.92 * n && two <= 0.99 * n,
            fmt::format("SD of fills, {}: coverage", what), "62 to 78 % within 1 SD, 92 to 99 % within 2 SD",
            fmt::format(
                "{:.1f} %, {:.1f} %; {} filled, {} left open; geometric means: error {:.2f} mm, SD {:.2f} mm",
                100 * one / n, 100 * two / n, filled, open, 1e3 * std::exp(log_error / filled),
                1e3 * std::exp(log_sd / filled)));
  print_row(beyond == 0, fmt::format("SD of fills, {}: the worst of each", what), "none beyond 6 SD",
            fmt::format("{} of {} beyond, and {} in which the recorded marker leaps; worst {:.1f} SD ({})",
                        beyond, filled, leaping, worst, where));
}

int run_check(int argc, char** argv) {
  const auto data = test_data_folder();
  if (!data) return skip_all("SDs of fills");
  const int gaps = argc > 1 ? std::atoi(argv[1]) : 4;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<GapTrial> trials;
  std::vector<BarGap> all;
  for (const std::string& file : gap_trial_files()) {
    trials.push_back(load_gap_trial(*data, file, kBarFrames, seed + trials.size(), false));
    draw_gaps(trials.back(), trials.size() - 1, gaps, seed, all);
  }
  const std::size_t real = trials.size();
  constexpr std::array kNames = {"rhythm", "sines", "reaches", "start", "random"};
  for (int k = 0; k < 4 * kLimbMovements; ++k) {
    const int movement = k % kLimbMovements;
    trials.push_back({.file = fmt::format("{} {}", kNames[static_cast<std::size_t>(movement)], k),
                      .markers = moving_limb(static_cast<LimbMovement>(movement),
                                             100 * seed + static_cast<std::uint64_t>(k))});
    draw_gaps(trials.back(), trials.size() - 1, gaps, seed, all);
  }
  parallel_for(static_cast<std::int64_t>(all.size()), 1, 0, [&](std::int64_t a, std::int64_t b) {
    for (std::int64_t k = a; k < b; ++k) {
      BarGap& g = all[static_cast<std::size_t>(k)];
      fill(trials[g.trial], g);
    }
  });
  if (argc > 3)
    for (const BarGap& g : all)
      if (g.worst > 6.0)
        fmt::print(
            "{:.1f} SD: {} {} s, marker {} from frame {}, {} hidden: error {:.2f} mm, SD {:.2f} mm{}\n",
            g.worst, trials[g.trial].file, kBarLengthsS[g.length], g.marker, g.first, g.blocked.size(),
            1e3 * g.rms_m, 1e3 * g.sd_m, g.leaps ? ", leaps" : "");
  judge(all, trials, "real movements", [&](const BarGap& g) { return g.trial < real; });
  judge(all, trials, "simulated movements", [&](const BarGap& g) { return g.trial >= real; });
  return exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("gap_bars", run_check);

}  // namespace

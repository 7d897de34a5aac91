// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Few markers on a limb: no angle that is called determined is a mirror pose's, however many samples are
// lost.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/units.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

constexpr double kMost = 5.0;  // standard deviations
constexpr double kLosses[] = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};

/// accept_motion rivals [subjects=N] [seed=N]: own human, samples lost at random, each subject once with one
/// share.
int run_check(int argc, char** argv) {
  int subjects = 50;
  std::uint64_t first = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("subjects=")) subjects = std::stoi(word.substr(9));
    if (word.starts_with("seed=")) first = std::stoull(word.substr(5));
  }
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  std::int64_t total = 0, one = 0, two = 0, beyond = 0, determined = 0, all = 0;
  double worst = 0.0;
  std::string where;
  std::int64_t beyond_of[std::size(kLosses)] = {}, frames_of[std::size(kLosses)] = {},
               total_of[std::size(kLosses)] = {};
  double seconds_of[std::size(kLosses)] = {}, solved_of[std::size(kLosses)] = {};
  for (int s = 0; s < subjects; ++s) {
    const auto share_idx = static_cast<std::size_t>(s) % std::size(kLosses);
    const double lost = kLosses[share_idx];
    const auto seed = first + static_cast<std::uint64_t>(s);
    const auto subject =
        simulation::simulate_subject(
            model, {.duration_s = 5.0, .rate_hz = 60.0, .seed = seed, .dropout_random = lost})
            .value();
    const auto result = motion::solve_ik(model, subject.markers).value();
    const auto& m = result.motion;
    seconds_of[share_idx] += result.solve_seconds;
    solved_of[share_idx] += static_cast<double>(m.frames());
    std::int64_t last_bad = -1;
    for (std::size_t i = 0; i < m.q.size(); ++i) {
      const auto c = i % m.coordinates.size();
      ++all;
      if (m.determined[i] == 0 || !(m.q_sd[i] > 0.0)) continue;
      ++determined;
      double off = m.q[i] - subject.truth.q[i];
      if (m.is_rotation[c]) off = std::remainder(off, 2.0 * std::numbers::pi);
      const double z = std::abs(off) / m.q_sd[i];
      ++total;
      one += z <= 1.0;
      two += z <= 2.0;
      ++total_of[share_idx];
      if (z > kMost) {
        ++beyond;
        ++beyond_of[share_idx];
        const auto frame = static_cast<std::int64_t>(i / m.coordinates.size());
        frames_of[share_idx] += frame != last_bad;
        last_bad = frame;
      }
      if (z <= worst) continue;
      worst = z;
      where =
          fmt::format("seed {}, {:.0f} % lost: {} in frame {}, {:.1f} deg off, SD {:.2f}", seed, 100.0 * lost,
                      m.coordinates[c], i / m.coordinates.size(), kDegPerRad * off, kDegPerRad * m.q_sd[i]);
    }
  }
  const auto share = [&](std::int64_t n, std::int64_t of) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, of));
  };
  print_row(beyond == 0, fmt::format("own human, 0 to 60 % of the samples lost, {} subjects", subjects),
            "no determined coordinate beyond 5 SD",
            fmt::format("{} of {}; worst {:.1f} SD ({})", beyond, total, worst, where));
  print_row(share(one, total) >= 63.0 && share(one, total) <= 73.0 && share(two, total) >= 92.0 &&
                share(two, total) <= 98.0,
            "the same: coverage", "63 to 73 % within 1 SD, 92 to 98 % within 2",
            fmt::format("{:.1f} and {:.1f} %", share(one, total), share(two, total)));
  for (std::size_t k = 0; k < std::size(kLosses); ++k)
    if (solved_of[k] > 0.0)
      print_note(fmt::format("the same, {:.0f} % lost", 100.0 * kLosses[k]),
                 fmt::format("beyond 5 SD {} of {} in {} frames; {:.2f} ms a frame", beyond_of[k],
                             total_of[k], frames_of[k], 1e3 * seconds_of[k] / solved_of[k]));
  print_note("the same: determined", fmt::format("{:.1f} % of {}", share(determined, all), all));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("rivals", run_check);

}  // namespace

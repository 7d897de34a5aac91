// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control to a wanted accuracy: what is promised is kept, what cannot be had is refused.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "acceptance/track_subject.h"
#include "kinemark/core/units.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_row;

/// Nearest to the truth that some cut-off comes.
double best_deg(const model::Model& model, const simulation::SimulatedSubject& s) {
  double best = 1e9;
  for (const double cutoff_hz : {1.5, 2.5, 4.0, 6.0}) {
    const auto track =
        motion::track_markers(model, s.markers, {.cutoff_hz = cutoff_hz, .error_bars = false}).value();
    best = std::min(best, joint_rms_deg(model, track.motion, s.truth));
  }
  return best;
}

struct Promises {
  int met = 0, missed = 0, refused = 0, wrongly = 0, other = 0;
  double lowest = 1e9, highest = 0.0, sum = 0.0;
  std::string where;
};

void try_accuracy(const model::Model& model, const DrawnSubject& s, double best, double wanted_deg,
                  Promises& all) {
  const auto track = motion::track_markers(model, s.recording.markers,
                                           {.accuracy_rad = kRadPerDeg * wanted_deg, .error_bars = false});
  if (!track) {
    const bool is_refusal = track.error().code == Code::bad_input &&
                            track.error().message.find("cannot be had") != std::string::npos;
    ++(is_refusal ? all.refused : all.other);
    all.wrongly += 1.15 * best <= wanted_deg;
    return;
  }
  const double error = joint_rms_deg(model, track->motion, s.recording.truth),
               ratio = error / (kDegPerRad * track->accuracy->predicted_rad);
  ++(error <= wanted_deg ? all.met : all.missed);
  all.sum += ratio;
  all.lowest = std::min(all.lowest, ratio);
  if (ratio > all.highest) {
    all.highest = ratio;
    all.where =
        fmt::format("{:.3f} deg of {:g}, {:g} Hz: {}", error, wanted_deg, track->accuracy->cutoff_hz, s.what);
  }
}

void compare(const model::Model& model, int subjects, std::uint64_t seed) {
  Promises all;
  for (int i = 0; i < subjects; ++i) {
    const auto s = draw(model, seed + static_cast<std::uint64_t>(i), 0.0);
    const double best = best_deg(model, s.recording);
    for (const double wanted : {0.2, 0.5, 1.0, 2.0}) try_accuracy(model, s, best, wanted, all);
  }
  const int promised = all.met + all.missed;
  print_row(promised > 0 && 20 * all.met >= 19 * promised && all.other == 0,
            fmt::format("0.2, 0.5, 1 and 2 deg asked for, {} subjects", subjects),
            "met in 95 % of what was promised, or refused",
            fmt::format("{} met, {} missed, {} refused, {} of them could be had", all.met, all.missed,
                        all.refused, all.wrongly));
  print_row(all.wrongly * 20 <= promised + all.refused,
            fmt::format("refused though it could be had, {} subjects", subjects), "<= 5 %",
            fmt::format("{} of {}", all.wrongly, promised + all.refused));
  print_row(all.lowest >= 0.85 && all.highest <= 1.1,
            fmt::format("achieved beside predicted error, {} subjects", subjects), "0.85 to 1.1",
            fmt::format("{:.3f} to {:.3f} ({}), {:.3f} on average", all.lowest, all.highest, all.where,
                        all.sum / std::max(1, promised)));
}

/// accept_motion track_accuracy [SUBJECTS] [seed=N]
int run_check(int argc, char** argv) {
  const auto [subjects, seed] = track_subject::Asked(argc, argv, 2);
  compare(human(), subjects, seed);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_accuracy", run_check);

}  // namespace

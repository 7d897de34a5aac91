// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control without any least squares, beside least squares on the same goals, against the truth:
// subjects that differ in kind of movement, speed, noise and skin, at three steps.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "acceptance/track_subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_note;
using testing_support::print_row;
using Clock = std::chrono::steady_clock;

/// What is asked of one step, and what came of it.
struct Step {
  const char* name;
  double step_s, omega_rad_s;
  double most;                                         ///< times the error of least squares
  double most_skin;                                    ///< the same with skin that moves
  int kept = 0, warned = 0, silent = 0, subjects = 0;  ///< silent: neither kept nor warned of
  double worst = 0.0, seconds = 0.0, squares = 0.0;
  std::string where;
  std::int64_t flagged = 0, solves = 0, frames = 0;
};

struct Sums {
  double least_squares = 0.0, least_seconds = 0.0, settled = 0.0, settled_seconds = 0.0, nearest = 1e9;
  std::int64_t frames = 0;
};

motion::TrackResult run(const model::Model& model, const data::Trajectories& markers, const Step& step,
                        bool settle) {
  return motion::track_markers(model, markers,
                               {.omega_rad_s = step.omega_rad_s, .step_s = step.step_s, .settle = settle})
      .value();
}

bool is_warned_of_step(const motion::TrackResult& track) {
  return std::any_of(track.fit.warnings.begin(), track.fit.warnings.end(),
                     [](const std::string& warning) { return warning.starts_with("steps of "); });
}

void try_subject(const model::Model& model, const DrawnSubject& s, bool skin, std::vector<Step>& steps,
                 Sums& sums) {
  const auto& [markers, true_markers, truth] = s.recording;
  const auto goals = motion::control_goals(markers).value();
  const auto begin = Clock::now();
  const auto ik = motion::solve_ik(model, goals, {.judge_samples = false, .error_bars = false}).value();
  sums.least_seconds += std::chrono::duration<double>(Clock::now() - begin).count();
  sums.frames += markers.frames();
  const double least = joint_rms_deg(model, ik.motion, truth);
  sums.least_squares += least * least;
  const auto settled = run(model, markers, steps[1], true);
  sums.settled_seconds += settled.solve_seconds;
  const double same = joint_rms_deg(model, settled.motion, truth);
  sums.settled += same * same;
  std::vector<data::JointMotion> motions;
  for (auto& step : steps) {
    const auto track = run(model, markers, step, false);
    const double error = joint_rms_deg(model, track.motion, truth), times = error / least;
    const bool kept = times <= (skin ? step.most_skin : step.most), warned = is_warned_of_step(track);
    step.kept += kept;
    step.warned += warned;
    step.silent += !kept && !warned;
    ++step.subjects;
    step.seconds += track.solve_seconds;
    step.squares += error * error;
    step.frames += markers.frames();
    step.flagged += track.flagged_frames;
    step.solves += track.solves;
    if (!(times <= step.worst)) {
      step.worst = times;
      step.where = fmt::format("{:.3f} for {:.3f} deg: {}", error, least, s.what);
    }
    motions.push_back(track.motion);
  }
  sums.nearest = std::min(sums.nearest, joint_rms_deg(model, motions.front(), motions.back()));
}

void compare(const model::Model& model, int subjects, std::uint64_t seed, bool skin) {
  std::vector<Step> steps{
      {.name = "1 ms", .step_s = 1e-3, .omega_rad_s = 100.0, .most = 1.02, .most_skin = 1.05},
      {.name = "as chosen (1/240 s)", .step_s = 0.0, .omega_rad_s = 100.0, .most = 1.02, .most_skin = 1.05},
      {.name = "1/60 s", .step_s = 1.0 / 60.0, .omega_rad_s = 30.0, .most = 1.05, .most_skin = 1.05}};
  Sums sums;
  for (int i = 0; i < subjects; ++i)
    try_subject(model, draw(model, seed + static_cast<std::uint64_t>(i), skin ? 1.0 : 0.0), skin, steps,
                sums);
  const std::string whom = fmt::format("{} subjects{}", subjects, skin ? " whose skin moves" : "");
  const auto per_frame = [](double seconds, std::int64_t frames) {
    return 1e6 * seconds / static_cast<double>(frames);
  };
  const auto rms = [&](double squares) { return std::sqrt(squares / subjects); };
  std::int64_t solves = 0;
  for (const auto& step : steps) {
    solves += step.solves;
    const bool whole_frames = step.step_s > 0.01;
    // 28 of 30; where steps cost more, the program has said so.
    const int enough = whole_frames ? 28 * step.subjects / 30 : step.subjects;
    print_row(
        step.kept >= enough && (whole_frames ? step.silent : step.warned) == 0 && step.flagged == 0,
        fmt::format("direct control, steps of {}, beside least squares, {}", step.name, whom),
        fmt::format("angles <= {} times as far from the truth{}; none flagged",
                    skin ? step.most_skin : step.most,
                    whole_frames ? " in 28 of 30, a smaller step asked for in the others"
                                 : ", and no smaller step asked for"),
        fmt::format("{} of {}, smaller steps asked for in {}; worst {:.4f} times ({}); {:.3f} deg in all, "
                    "least squares {:.3f}; "
                    "{} flagged; {:.0f} us a frame",
                    step.kept, step.subjects, step.warned, step.worst, step.where, rms(step.squares),
                    rms(sums.least_squares), step.flagged, per_frame(step.seconds, step.frames)));
  }
  print_row(solves == 0, fmt::format("poses solved by inverse kinematics after the first, {}", whom), "none",
            fmt::format("{} in {} frames of {} runs", solves, sums.frames, 3 * subjects));
  print_row(sums.nearest >= 1e-4, fmt::format("angles at 1 ms beside those at 1/60 s, {}", whom),
            "they differ, by 1e-4 deg or more", fmt::format("{:.4f} deg at least", sums.nearest));
  print_note(
      fmt::format("time of a frame and the error that it buys, {}", whom),
      fmt::format("control {:.0f} us and {:.3f} deg; settled {:.0f} us and {:.3f} deg; inverse kinematics "
                  "{:.0f} us and {:.3f} deg",
                  per_frame(steps[1].seconds, sums.frames), rms(steps[1].squares),
                  per_frame(sums.settled_seconds, sums.frames), rms(sums.settled),
                  per_frame(sums.least_seconds, sums.frames), rms(sums.least_squares)));
}

/// accept_motion track_direct [SUBJECTS] [seed=N]
int run_check(int argc, char** argv) {
  const auto [subjects, seed] = track_subject::Asked(argc, argv, 3);
  const auto model = human();
  compare(model, subjects, seed, false);
  compare(model, std::max(1, subjects / 3), seed, true);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_direct", run_check);

}  // namespace

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Several levels of direct marker control: by weights, beside least squares; strict ones, what they cost, and
// that none of them leaves its goals without being said: at limits, in singular poses, where markers are
// lost, where goals contradict one another.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/track_subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_row;

double least_squares_deg(const model::Model& model, const simulation::SimulatedSubject& s) {
  const auto goals = motion::control_goals(s.markers).value();
  const auto ik = motion::solve_ik(model, goals, {.judge_samples = false, .error_bars = false}).value();
  return joint_rms_deg(model, ik.motion, s.truth);
}

/// More noise on the markers of each level than on those of the one above.
void add_noise(const std::vector<motion::TrackLevel>& levels, std::uint64_t seed,
               data::Trajectories& markers) {
  Random random(seed, 0x6c6576656c);
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (const auto& name : levels[i].markers) {
      const auto m = std::ranges::find(markers.names, name) - markers.names.begin();
      for (std::int64_t f = 0; f < markers.frames(); ++f)
        for (int axis = 0; axis < 3; ++axis)
          markers.x(f, m)[axis] += 2e-3 * static_cast<double>(i) * random.gaussian();
    }
}

void weighted(const model::Model& model, int subjects, std::uint64_t seed) {
  for (const bool uneven : {false, true}) {
    double worst = 0.0, squares = 0.0, least_squares = 0.0, largest_weight = 0.0;
    int kept = 0;
    std::int64_t flagged = 0, solves = 0;
    for (int i = 0; i < subjects; ++i) {
      auto s = draw(model, seed + static_cast<std::uint64_t>(i), 0.0);
      const auto levels = three_levels(model);
      if (uneven) add_noise(levels, seed + static_cast<std::uint64_t>(i), s.recording.markers);
      const auto track =
          motion::track_markers(model, s.recording.markers, {.levels = levels, .error_bars = false}).value();
      const double error = joint_rms_deg(model, track.motion, s.recording.truth),
                   least = least_squares_deg(model, s.recording);
      kept += error <= 1.05 * least;
      worst = larger(worst, error / least);
      squares += error * error;
      least_squares += least * least;
      flagged += track.flagged_frames;
      solves += track.solves;
      largest_weight = larger(largest_weight, track.levels.front().weight / track.levels.back().weight);
    }
    print_row(kept == subjects && flagged == 0 && solves == 0 && (!uneven || squares < least_squares),
              fmt::format("three levels by weights beside least squares, {} subjects{}", subjects,
                          uneven ? ", the lower the level the noisier" : ""),
              uneven ? "angles <= 1.05 times as far from the truth, nearer in all; no solver"
                     : "angles <= 1.05 times as far from the truth; no solver",
              fmt::format("{} of {}, worst {:.4f} times; {:.3f} deg in all, least squares {:.3f}; weights up "
                          "to {:.1f} : 1; {} flagged, {} solves",
                          kept, subjects, worst, std::sqrt(squares / subjects),
                          std::sqrt(least_squares / subjects), largest_weight, flagged, solves));
  }
}

/// What became of strict levels in some recordings.
struct Strict {
  int runs = 0, relaxed_runs = 0, warned = 0;
  std::int64_t frames = 0, beyond = 0, silent = 0, relaxed = 0, unmet = 0;
  double worst_recovery_s = 0.0, worst_m = 0.0, squares = 0.0, least = 0.0;
  std::int64_t recoveries = 0;
};

/// In each stretch in one sum of squares: how long some level stays beyond its bound where one sum of squares
/// alone keeps all of them.
void count_recoveries(const motion::TrackResult& track, const motion::TrackResult& joined, Strict& sum) {
  const std::size_t L = track.levels.size();
  const auto beyond = [&](const motion::TrackResult& run, std::size_t f) {
    for (std::size_t i = 0; i < L; ++i)
      if (run.level_error[f * L + i] > track.levels[i].bound_m) return true;
    return false;
  };
  for (std::size_t f = 1; f < track.relaxed.size(); ++f) {
    if (track.relaxed[f] == 0 || track.relaxed[f - 1] != 0) continue;
    std::size_t end = f;
    while (end < track.relaxed.size() && beyond(track, end) && !beyond(joined, end)) ++end;
    if (end < track.relaxed.size() && beyond(joined, end)) continue;  // cannot be met
    std::size_t begin = f;  // of the stretch beyond, before anything was done about it
    while (begin > 0 && beyond(track, begin - 1) && !beyond(joined, begin - 1)) --begin;
    if (begin == end) continue;
    ++sum.recoveries;
    sum.worst_recovery_s =
        std::max(sum.worst_recovery_s, static_cast<double>(end - begin) / track.motion.time.rate_hz);
  }
}

/// RMS distance of a level's goals to the body of the result, from the distances to the samples; NaN where a
/// marker of it is not seen in this frame or near it.
double level_error(const motion::TrackResult& track, const motion::TrackLevel& level,
                   const data::Trajectories& samples, const data::Trajectories& goals, std::int64_t f) {
  double squares = 0.0;
  for (const auto& name : level.markers) {
    const auto in_model = std::ranges::find(track.motion.markers, name) - track.motion.markers.begin();
    const auto m = std::ranges::find(samples.names, name) - samples.names.begin();
    for (std::int64_t near = std::max<std::int64_t>(0, f - 12); near < std::min(samples.frames(), f + 13);
         ++near)
      if (!samples.present(near, m)) return std::nan("");
    const double* error =
        track.motion.marker_error.data() + 3 * (f * std::ssize(track.motion.markers) + in_model);
    squares += (Eigen::Map<const Eigen::Vector3d>(error) - (samples.x(f, m) - goals.x(f, m))).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(level.markers.size()));
}

/// A frame is silent when a level is beyond its bound and its status or the findings do not say so.
void count_silent(const motion::TrackResult& track, const data::Trajectories& samples, Strict& sum) {
  const std::size_t L = track.levels.size();
  const auto levels = three_levels(human());
  const auto goals = motion::control_goals(samples).value();
  for (std::size_t f = 0; f < track.relaxed.size(); ++f) {
    bool beyond = false, found = true;
    for (std::size_t i = 0; i < L; ++i) {
      const double alone = level_error(track, levels[i], samples, goals, static_cast<std::int64_t>(f));
      if (!(track.level_error[f * L + i] > track.levels[i].bound_m ||
            alone > 1.001 * track.levels[i].bound_m))
        continue;
      beyond = true;
      found = found && std::ranges::any_of(track.fit.findings, [&](const data::Finding& finding) {
                return finding.subject == fmt::format("level {}", i + 1) &&
                       std::ranges::count(finding.frames, static_cast<std::int64_t>(f)) == 1;
              });
    }
    sum.beyond += beyond;
    sum.silent += beyond && (track.motion.status[f] != data::FrameStatus::not_converged || !found);
    sum.relaxed += track.relaxed[f];
  }
}

void try_strict(const model::Model& model, const simulation::SimulatedSubject& s, double bound_m,
                Strict& sum) {
  const auto levels = three_levels(model);
  const auto track =
      motion::track_markers(model, s.markers,
                            {.levels = levels, .strict = true, .level_bound_m = bound_m, .error_bars = false})
          .value();
  auto equal = levels;
  for (auto& level : equal) level.weight = 1.0;
  const auto joined = motion::track_markers(model, s.markers, {.levels = equal, .error_bars = false}).value();
  ++sum.runs;
  sum.frames += track.motion.frames();
  count_silent(track, s.markers, sum);
  count_recoveries(track, joined, sum);
  sum.relaxed_runs += track.relaxations > 0;
  sum.warned += std::ranges::any_of(track.fit.warnings, [](const std::string& warning) {
    return warning.starts_with("strict levels contradict");
  });
  for (const auto& level : track.levels) {
    sum.unmet += level.unmet;
    sum.worst_m = std::max(sum.worst_m, level.max_error_m);
  }
  const double error = joint_rms_deg(model, track.motion, s.truth),
               least = joint_rms_deg(model, joined.motion, s.truth);
  sum.squares += error * error;
  sum.least += least * least;
}

void print_strict(const Strict& sum, const std::string& what, bool trips) {
  print_row(
      sum.silent == 0 && sum.worst_recovery_s <= 0.2 && (!trips || sum.beyond > 0),
      "three strict levels, " + what,
      fmt::format("each frame beyond a bound is found, {}within bounds 0.2 s after",
                  trips ? "there are some; " : ""),
      fmt::format("{} of {} frames beyond, {} silent; {} frames relaxed in {} of {} runs, said before {}; "
                  "{} recoveries, the longest {:.3f} s; cannot be met in {}; worst level {:.1f} mm; "
                  "angles {:.3f} deg, in one sum of squares {:.3f}",
                  sum.beyond, sum.frames, sum.silent, sum.relaxed, sum.relaxed_runs, sum.runs, sum.warned,
                  sum.recoveries, sum.worst_recovery_s, sum.unmet, 1e3 * sum.worst_m,
                  std::sqrt(sum.squares / sum.runs), std::sqrt(sum.least / sum.runs)));
}

model::Model with_ranges(double share) {
  auto description = io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
  for (auto& c : description.coordinates)
    if (c.name.starts_with("knee") || c.name.starts_with("elbow")) {
      const double middle = 0.5 * (c.range_min + c.range_max), half = 0.5 * (c.range_max - c.range_min);
      c.range_min = middle - share * half;
      c.range_max = middle + share * half;
    }
  return model::Model::compile(description).value();
}

model::Model with_straight_limbs() {
  auto description = io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
  for (auto& c : description.coordinates)
    if (c.name.starts_with("knee") || c.name.starts_with("elbow")) {
      c.default_value = 0.0;
      c.locked = true;
    }
  return model::Model::compile(description).value();
}

/// Markers of the highest level that are lost for a second, and again.
void lose_markers(const model::Model& model, data::Trajectories& markers) {
  const auto levels = three_levels(model);
  for (const auto& name : levels[1].markers) {
    const auto m = std::ranges::find(markers.names, name) - markers.names.begin();
    for (std::int64_t f = 120; f < 300; ++f)
      if (f < 180 || f >= 240) markers.set_missing(f, m, data::SampleState::missing);
  }
}

/// For half a second the markers of the highest level lie where no pose has them.
void contradict(const model::Model& model, data::Trajectories& markers) {
  const auto levels = three_levels(model);
  Random random(7, 0x636f6e);
  for (const auto& name : levels[0].markers) {
    const auto m = std::ranges::find(markers.names, name) - markers.names.begin();
    const Eigen::Vector3d off(random.gaussian(), random.gaussian(), random.gaussian());
    for (std::int64_t f = 150; f < 180; ++f) {
      const double u = static_cast<double>(f - 150) / 30.0;
      markers.x(f, m) += 0.018 * std::pow(std::sin(3.14159265358979 * u), 2) * off;
    }
  }
}

void strict(const model::Model& model, int subjects, std::uint64_t seed) {
  Strict noise, skin, bounded, limits, straight, lost, planted;
  const auto narrow = with_ranges(0.5), still = with_straight_limbs();
  for (int i = 0; i < subjects; ++i) {
    const auto s = seed + static_cast<std::uint64_t>(i);
    try_strict(model, draw(model, s, 0.0).recording, 0.0, noise);
    try_strict(model, draw(model, s, 1.0).recording, 0.0, skin);
    try_strict(model, draw(model, s, 1.0).recording, 0.02, bounded);
    try_strict(narrow, draw(model, s, 0.0).recording, 0.02, limits);
    try_strict(model, draw(still, s, 0.0).recording, 0.02, straight);
    auto gap = draw(model, s, 0.0).recording;
    lose_markers(model, gap.markers);
    try_strict(model, gap, 0.02, lost);
    auto wrong = draw(model, s, 0.0).recording;
    contradict(model, wrong.markers);
    try_strict(model, wrong, 0.02, planted);
  }
  const auto who = fmt::format(", {} subjects", subjects);
  print_strict(noise, "noise alone" + who, false);
  print_strict(skin, "skin that moves" + who, false);
  print_strict(bounded, "skin that moves, bound 20 mm" + who, false);
  print_strict(limits, "knees and elbows beyond their ranges" + who, true);
  print_strict(straight, "stretched limbs" + who, false);
  print_strict(lost, "markers of a level lost for a second" + who, false);
  print_strict(planted, "half a second of contradicting goals" + who, false);
}

/// accept_motion track_levels [SUBJECTS] [seed=N]
int run_check(int argc, char** argv) {
  const auto [subjects, seed] = track_subject::Asked(argc, argv, 2);
  const auto model = human();
  weighted(model, subjects, seed);
  strict(model, std::max(1, subjects / 2), seed);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_levels", run_check);

}  // namespace

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/judgement.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kHeldFrames = 3;   // equal values in a row: noise never repeats itself that often
constexpr double kHeldTravel_m = 0.5e-3;  // what the body must have moved meanwhile
constexpr double kHeldGrid = 4.0;         // and so many times the last digit that the recording keeps
constexpr double kZeroStep_m = 5e-3;      // what a coordinate of 0 must lie away from its neighbours
constexpr std::int64_t kSoundBeside = 2;  // frames on each side of a sound one
constexpr double kOneSided = 20.0;        // standard deviations: what did not come back must be as far
constexpr std::int64_t kFewFrames = 3;    // at an end of the recording: too short to be a new position

/// Where the model has the marker, by the pose with all samples.
Eigen::Vector3d modelled(const Problem& problem, const data::Trajectories& markers,
                         const SolvedFrames& solved, std::int64_t f, Eigen::Index m) {
  const Eigen::Index M = problem.model.marker_count();
  const Eigen::Map<const Eigen::Vector3d> error(solved.marker_error.data() + 3 * (f * M + m));
  return markers.x(problem.first_frame + f, problem.data_marker[at(m)]) - error;
}

/// The last digit that a marker's coordinates keep: their smallest step but none, m.
double find_digit(const Problem& problem, const data::Trajectories& markers, int d) {
  double digit = std::numeric_limits<double>::infinity();
  for (std::int64_t g = problem.first_frame + 1; g < problem.first_frame + problem.frames; ++g) {
    if (!markers.present(g, d) || !markers.present(g - 1, d)) continue;
    for (const double step : (markers.x(g, d) - markers.x(g - 1, d)).cwiseAbs())
      if (step > 0.0) digit = std::min(digit, step);
  }
  return digit;
}

void find_held(const Problem& problem, const data::Trajectories& markers, const SolvedFrames& solved,
               std::vector<Outlier>& out) {
  const Eigen::Index M = problem.model.marker_count();
  const auto same = [&](std::int64_t f, Eigen::Index m) {
    const int d = problem.data_marker[at(m)];
    const std::int64_t g = problem.first_frame + f;
    return markers.present(g, d) && markers.present(g - 1, d) && markers.x(g, d) == markers.x(g - 1, d);
  };
  // Frames that repeat as a whole are the recorder's, not a marker's.
  std::vector<std::uint8_t> repeated(at(problem.frames), 0);
  std::vector<std::int64_t> run(at(M), 0);
  for (std::int64_t f = 1; f <= problem.frames; ++f) {
    Eigen::Index held = 0, seen = 0;
    for (Eigen::Index m = 0; m < M && f < problem.frames; ++m) {
      seen += markers.present(problem.first_frame + f, problem.data_marker[at(m)]);
      held += same(f, m);
    }
    const bool whole = 2 * held > seen;
    for (Eigen::Index m = 0; m < M; ++m) {
      if (f < problem.frames && !whole && same(f, m)) {
        ++run[at(m)];
        continue;
      }
      const std::int64_t first = f - run[at(m)];  // the first repeat; the sample before it is true
      if (run[at(m)] + 1 >= kHeldFrames) {
        const Eigen::Vector3d begin = modelled(problem, markers, solved, first - 1, m);
        double travel = 0.0;
        for (std::int64_t g = first; g < f; ++g)
          travel = std::max(travel, (modelled(problem, markers, solved, g, m) - begin).norm());
        // A marker that alone fixes a joint holds the model back: its leap at the end tells, or its speed
        // before.
        const int d = problem.data_marker[at(m)];
        const std::int64_t g = problem.first_frame + first - 1;
        if (f < problem.frames && markers.present(problem.first_frame + f, d))
          travel = std::max(travel, (markers.x(problem.first_frame + f, d) - markers.x(g, d)).norm());
        else if (first >= 2 && markers.present(g - 1, d))
          travel = std::max(travel,
                            static_cast<double>(run[at(m)]) * (markers.x(g, d) - markers.x(g - 1, d)).norm());
        if (travel > kHeldTravel_m && travel > kHeldGrid * find_digit(problem, markers, d))
          out.push_back({.marker = static_cast<int>(m),
                         .first_frame = first,
                         .last_frame = f - 1,
                         .length_m = travel,
                         .why = Outlier::Why::held});
      }
      run[at(m)] = 0;
    }
  }
}

void find_zero_coordinates(const Problem& problem, const data::Trajectories& markers,
                           std::vector<Outlier>& out) {
  for (Eigen::Index m = 0; m < problem.model.marker_count(); ++m) {
    const int d = problem.data_marker[at(m)];
    for (std::int64_t f = 1; f + 1 < problem.frames; ++f) {
      const std::int64_t g = problem.first_frame + f;
      if (!markers.present(g, d) || (markers.x(g, d).array() != 0.0).all()) continue;
      if (!markers.present(g - 1, d) || !markers.present(g + 1, d)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double before = markers.x(g - 1, d)[axis], after = markers.x(g + 1, d)[axis];
        const double step = std::abs(0.5 * (before + after));
        if (markers.x(g, d)[axis] != 0.0 || before == 0.0 || after == 0.0 || before * after < 0.0 ||
            step < kZeroStep_m)
          continue;
        out.push_back({.marker = static_cast<int>(m),
                       .first_frame = f,
                       .last_frame = f,
                       .length_m = step,
                       .why = Outlier::Why::zero});
        break;
      }
    }
  }
}

/// A frame whose samples may be believed: the cheapest stretch of frames that see nearly all markers, and
/// where there is one, the same in each. Where a marker comes or goes the pose jumps, and with it the speed.
std::int64_t find_sound_frame(const Problem& problem, const data::Trajectories& markers,
                              const SolvedFrames& solved) {
  const std::int64_t F = problem.frames;
  std::vector<int> seen(at(F), 0), changes(at(F), 0);  // in number; from the frame before
  for (std::int64_t f = 0; f < F; ++f)
    for (const int d : problem.data_marker) {
      const bool present = markers.present(problem.first_frame + f, d);
      seen[at(f)] += present;
      changes[at(f)] += f > 0 && present != markers.present(problem.first_frame + f - 1, d);
    }
  const int best = *std::ranges::max_element(seen);
  std::int64_t found = 0;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  auto cheapest = std::pair(true, kNone);  // whether the markers change, what the dearest frame costs
  for (std::int64_t f = 0; f < F; ++f) {
    auto dearest = std::pair(false, 0.0);
    const std::int64_t from = std::max<std::int64_t>(0, f - kSoundBeside);
    for (auto g = from; g <= std::min(F - 1, f + kSoundBeside); ++g) {
      const bool good = 20 * seen[at(g)] >= 19 * best && solved.status[at(g)] == data::FrameStatus::converged;
      dearest.first = dearest.first || !good || (g > from && changes[at(g)] > 0);
      dearest.second = std::max(dearest.second, good ? solved.cost[at(g)] : kNone);
    }
    if (dearest < cheapest) {
      cheapest = dearest;
      found = f;
    }
  }
  return found;
}

}  // namespace

std::vector<Outlier> find_plain_defects(const Problem& problem, const data::Trajectories& markers,
                                        const SolvedFrames& solved) {
  std::vector<Outlier> found;
  find_held(problem, markers, solved, found);
  find_zero_coordinates(problem, markers, found);
  return found;
}

Judgement judge_recording(const Problem& problem, const IkOptions& options, const data::Trajectories& markers,
                          const SolvedFrames& solved) {
  Judgement judgement;
  StepScale scale(problem, solved);
  const std::int64_t sound = find_sound_frame(problem, markers, solved), last = problem.frames - 1;
  for (const std::int64_t end : {last, std::int64_t{0}})
    for (const Outlier& outlier : judge_samples(problem, options, markers, solved, scale, sound, end)) {
      const std::int64_t frames = outlier.last_frame - outlier.first_frame + 1;
      const bool to_the_end = outlier.last_frame == last || outlier.first_frame == 0;
      // What came back is bad; what did not may have a new position now, unless the model says no.
      const bool bad =
          outlier.returned ||
          (outlier.distance > kOneSided && (outlier.clearly_wrong() || (to_the_end && frames <= kFewFrames)));
      (bad ? judgement.bad : judgement.doubtful).push_back(outlier);
    }
  return judgement;
}

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kSoundBeside = 2;  // frames on each side of a sound one
constexpr double kOneSided = 20.0;        // standard deviations: what did not come back must be as far
constexpr std::int64_t kFewFrames = 3;    // at an end of the recording: too short to be a new position

}  // namespace

std::int64_t find_sound_frame(const Problem& problem, const data::Trajectories& markers,
                              const SolvedFrames& solved) {
  const std::int64_t F = problem.frames;
  std::vector<int> seen(at(F), 0), changes(at(F), 0);  // in number; from the frame before
  std::vector<std::uint8_t> left_out(at(F), 0);        // 1: a sample was
  for (std::int64_t f = 0; f < F; ++f)
    for (const int d : problem.data_marker) {
      const bool present = markers.present(problem.first_frame + f, d);
      seen[at(f)] += present;
      if (markers.state[markers.index(problem.first_frame + f, d)] == data::SampleState::rejected)
        left_out[at(f)] = 1;
      changes[at(f)] += f > 0 && present != markers.present(problem.first_frame + f - 1, d);
    }
  const int best = *std::ranges::max_element(seen);
  std::int64_t found = 0;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  // Whether the frames are bad, samples were left out (a frame costs less without them), markers change; what
  // the dearest frame costs.
  auto cheapest = std::tuple(true, true, true, kNone);
  for (std::int64_t f = 0; f < F; ++f) {
    auto dearest = std::tuple(false, false, false, 0.0);
    auto& [bad, lacks, changed, cost] = dearest;
    const std::int64_t from = std::max<std::int64_t>(0, f - kSoundBeside);
    for (auto g = from; g <= std::min(F - 1, f + kSoundBeside); ++g) {
      const bool good = 20 * seen[at(g)] >= 19 * best && solved.status[at(g)] == data::FrameStatus::converged;
      bad = bad || !good;
      lacks = lacks || left_out[at(g)] != 0;
      changed = changed || (g > from && changes[at(g)] > 0);
      cost = std::max(cost, good ? solved.cost[at(g)] : kNone);
    }
    if (dearest < cheapest) {
      cheapest = dearest;
      found = f;
    }
  }
  return found;
}

std::vector<Outlier> judge_samples(const Problem& problem, const IkOptions& options,
                                   const data::Trajectories& markers, const SolvedFrames& solved,
                                   StepScale& scale, std::int64_t sound, std::int64_t last,
                                   std::int64_t* solves) {
  const Eigen::Index M = problem.model.marker_count();
  FrameJudge judge(problem, options, markers.time.rate_hz, scale);
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd seen(M);
  const auto frame = [&](std::int64_t f) {
    problem.observe(markers, f, y, seen);
    return JudgedFrame{.index = f,
                       .y = &y,
                       .seen = &seen,
                       .state = solved.states.col(f).data(),
                       .position = solved.positions.data() + 3 * f * M};
  };
  const std::int64_t direction = last >= sound ? 1 : -1, before = sound - direction;
  Eigen::VectorXd state_before;
  if (before >= 0 && before < problem.frames) state_before = solved.states.col(before);
  judge.begin(frame(sound), state_before.size() > 0 ? &state_before : nullptr, direction);
  for (std::int64_t f = sound; f != last;) judge.judge(frame(f += direction));
  if (solves != nullptr) *solves += judge.solves();
  return judge.finish();
}

Judgement judge_recording(const Problem& problem, const IkOptions& options, const data::Trajectories& markers,
                          const SolvedFrames& solved) {
  Judgement judgement;
  StepScale scale(problem, solved);
  const std::int64_t sound = find_sound_frame(problem, markers, solved), last = problem.frames - 1;
  for (const std::int64_t end : {last, std::int64_t{0}})
    for (const Outlier& outlier :
         judge_samples(problem, options, markers, solved, scale, sound, end, &judgement.solves)) {
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

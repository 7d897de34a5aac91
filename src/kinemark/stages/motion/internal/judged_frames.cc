// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/judged_frames.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/internal/plain_defects.h"
#include "kinemark/stages/motion/internal/rejected_samples.h"

namespace kinemark::motion::internal {
namespace {

constexpr int kRounds = 3;  // what was hidden behind a bad sample shows in the next one

/// Take the samples of the outliers away; true for each frame in which there were some.
std::vector<std::uint8_t> leave_out(const Problem& problem, const std::vector<Outlier>& outliers,
                                    data::Trajectories& markers, bool& any) {
  std::vector<std::uint8_t> concerned(at(problem.frames), 0);
  any = false;
  for (const Outlier& outlier : outliers)
    for (std::int64_t f = outlier.first_frame; f <= outlier.last_frame; ++f) {
      const int d = problem.data_marker[at(outlier.marker)];
      if (!markers.present(problem.first_frame + f, d)) continue;
      markers.set_missing(problem.first_frame + f, d, data::SampleState::rejected);
      concerned[at(f)] = 1;
      any = true;
    }
  return concerned;
}

/// Join stretches of a marker that touch.
std::vector<Outlier> joined(std::vector<Outlier> outliers) {
  std::ranges::stable_sort(outliers, {},
                           [](const Outlier& s) { return std::tuple(s.marker, s.first_frame); });
  std::vector<Outlier> out;
  for (const Outlier& s : outliers) {
    if (!out.empty() && out.back().marker == s.marker && s.first_frame <= out.back().last_frame + 1 &&
        out.back().why == s.why && out.back().partner == s.partner) {
      Outlier& last = out.back();
      last.last_frame = std::max(last.last_frame, s.last_frame);
      last.distance = std::max(last.distance, s.distance);
      last.length_m = std::max(last.length_m, s.length_m);
    } else if (!out.empty() && out.back().marker == s.marker && s.first_frame <= out.back().last_frame) {
      if (s.last_frame <= out.back().last_frame) continue;
      out.push_back(s);
      out.back().first_frame = std::prev(out.end(), 2)->last_frame + 1;
    } else {
      out.push_back(s);
    }
  }
  return out;
}

}  // namespace

std::optional<JudgedFrames> solve_and_judge(const Problem& problem, const IkOptions& options,
                                            const data::Trajectories& markers, const Progress& progress) {
  JudgedFrames judged;
  FrameWalk walk(problem, options, progress);
  // Labels first: a pose that follows exchanged markers spoils the frames beside.
  if (options.judge_samples) judged.exchanges = find_path_exchanges(problem, markers);
  if (!judged.exchanges.empty()) {
    judged.kept = markers;
    exchange_back(problem, judged.exchanges, *judged.kept);
  }
  const auto now = [&]() -> const data::Trajectories& { return judged.kept ? *judged.kept : markers; };
  if (!walk.run(now(), options.judge_samples, judged.solved)) return std::nullopt;
  if (!options.judge_samples) return judged;
  const auto solve_again = [&](const std::vector<std::uint8_t>& concerned) {
    walk.solve_again(*judged.kept, concerned, judged.solved);
    walk.mend(*judged.kept, judged.solved);
  };
  const auto reject = [&](const std::vector<Outlier>& outliers) {
    if (outliers.empty()) return false;
    if (!judged.kept) judged.kept = markers;
    bool any = false;
    const auto concerned = leave_out(problem, outliers, *judged.kept, any);
    if (!any) return false;
    judged.rejected.insert(judged.rejected.end(), outliers.begin(), outliers.end());
    solve_again(concerned);
    return true;
  };
  const auto undo = [&](const std::vector<Exchange>& exchanges) {
    if (exchanges.empty()) return false;
    if (!judged.kept) judged.kept = markers;
    exchange_back(problem, exchanges, *judged.kept);
    add_exchanges(exchanges, judged.exchanges);
    std::vector<std::uint8_t> concerned(at(problem.frames), 0);
    for (const Exchange& exchange : exchanges)
      for (const auto f : exchange.frames) concerned[at(f)] = 1;
    solve_again(concerned);
    return true;
  };
  reject(find_plain_defects(problem, now(), judged.solved));
  for (int round = 0; round < kRounds; ++round) {
    auto judgement = judge_recording(problem, options, now(), judged.solved);
    judged.doubtful = std::move(judgement.doubtful);
    // What is not believed even when exchanged back is left out in the end.
    const bool undone = round + 1 < kRounds && undo(take_mutual(judgement.bad));
    if (!reject(judgement.bad) && !undone) break;
  }
  if (judged.kept) {
    bool any = false;
    data::Trajectories counted = markers;
    exchange_back(problem, judged.exchanges, counted);
    const auto concerned = leave_out(problem, judged.rejected, counted, any);
    StepScale scale(problem, judged.solved);
    judged.filled = fill_rejected(problem, *judged.kept, concerned, scale, judged.solved);
    walk.solve_filled(*judged.kept, *judged.filled, concerned, judged.solved);
    judged.solved.iterations = walk.iterations();
  }
  judged.rejected = joined(std::move(judged.rejected));
  judged.solved.positions = {};
  return judged;
}

}  // namespace kinemark::motion::internal

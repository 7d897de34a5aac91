// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/judged_frames.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/expected_pose_fit.h"
#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/step_scale.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kHeldFrames = 3;   // equal values in a row: noise never repeats itself that often
constexpr double kHeldTravel_m = 0.5e-3;  // what the body must have moved meanwhile
constexpr double kHeldGrid = 4.0;         // and so many times the last digit that the recording keeps
constexpr double kZeroStep_m = 5e-3;      // what a coordinate of 0 must lie away from its neighbours

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

constexpr double kFarthest_s = 1.0;
constexpr double kLeastPrior = 0.5;  // rad or m: nothing is expected more vaguely

/// The nearest frames before and behind f that no sample of was left out, for one marker or, without one, for
/// the pose; -1 where there are none.
struct Beside {
  std::int64_t before = -1, behind = -1;
};

class FramesBeside {
 public:
  FramesBeside(const Problem& problem, const data::Trajectories& kept,
               const std::vector<std::uint8_t>& concerned)
      : problem_(problem),
        kept_(kept),
        concerned_(concerned),
        far_(std::max<std::int64_t>(8, std::llround(kFarthest_s * kept.time.rate_hz))) {}

  [[nodiscard]] Beside of(std::int64_t f, int marker) const {
    return {.before = find(f, marker, -1), .behind = find(f, marker, 1)};
  }

 private:
  [[nodiscard]] std::int64_t find(std::int64_t f, int marker, int direction) const {
    for (std::int64_t g = f + direction, n = 0; g >= 0 && g < problem_.frames; g += direction) {
      if (concerned_[at(g)]) continue;
      if (++n > far_) break;
      if (marker < 0 || kept_.present(problem_.first_frame + g, problem_.data_marker[at(marker)])) return g;
    }
    return -1;
  }

  const Problem& problem_;
  const data::Trajectories& kept_;
  const std::vector<std::uint8_t>& concerned_;
  std::int64_t far_;
};

double share_of(const Beside& beside, std::int64_t f) {
  if (beside.before < 0) return 1.0;
  if (beside.behind < 0) return 0.0;
  return static_cast<double>(f - beside.before) / static_cast<double>(beside.behind - beside.before);
}

/// Replace every sample that was left out (state rejected) by the position that its marker has on the body in
/// the frames beside. Without it the constant part of a marker's residual would vanish for some frames, and
/// the pose would jump. The body's pose comes from all other markers and their positions on the body in the
/// frames beside. A sample whose position there is not known stays missing.
///
/// @param concerned  F, not 0 for the frames with such samples; their states become the poses found
/// @return           the recording with those samples, in the state model_filled
data::Trajectories fill_rejected(const Problem& problem, const data::Trajectories& kept,
                                 const std::vector<std::uint8_t>& concerned, StepScale& scale,
                                 SolvedFrames& solved) {
  const auto& model = problem.model;
  const int M = model.marker_count();
  data::Trajectories filled = kept;
  const FramesBeside frames_beside(problem, kept, concerned);
  ExpectedPoseFit fit(problem);
  Expectation expected;
  expected.position.setZero(3, M);
  expected.position_sd.setZero(M);
  expected.bound.setConstant(M, std::numeric_limits<double>::infinity());
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd seen(M), way(model.speed_count());
  const auto position = [&](std::int64_t f, int m) {
    return Eigen::Vector3d(
        Eigen::Map<const Eigen::Vector3f>(solved.positions.data() + 3 * (f * M + m)).cast<double>());
  };
  for (std::int64_t f = 0; f < problem.frames; ++f) {
    if (!concerned[at(f)]) continue;
    const Beside beside = frames_beside.of(f, -1);
    if (beside.before < 0 && beside.behind < 0) continue;
    // The pose: between those beside, as vaguely as they are far.
    const double share = share_of(beside, f);
    if (beside.before >= 0 && beside.behind >= 0) {
      expected.x = solved.states.col(beside.before);
      model::difference(model, expected.x, solved.states.col(beside.behind), way);
      way *= share;
      model::integrate(model, expected.x, way);
      const double gap = static_cast<double>(beside.behind - beside.before);
      expected.speed_sd = (scale.speed * std::max(1.0, 0.25 * gap * gap)).cwiseMin(kLeastPrior);
    } else {
      const std::int64_t near = std::max(beside.before, beside.behind);
      expected.x = solved.states.col(near);
      expected.speed_sd =
          (2.0 * scale.stride * static_cast<double>(std::abs(f - near))).cwiseMin(kLeastPrior);
    }
    for (int m = 0; m < M; ++m) {
      const Beside own = frames_beside.of(f, m);
      if (own.before < 0 && own.behind < 0) {
        expected.position_sd[m] = std::numeric_limits<double>::infinity();
        continue;
      }
      const double s = share_of(own, f);
      expected.position.col(m).setZero();
      if (own.before >= 0) expected.position.col(m) += (1.0 - s) * position(own.before, m);
      if (own.behind >= 0) expected.position.col(m) += s * position(own.behind, m);
      const std::int64_t near = std::min(own.before < 0 ? problem.frames : f - own.before,
                                         own.behind < 0 ? problem.frames : own.behind - f);
      expected.position_sd[m] = scale.position_sd_after(m, near);
    }
    problem.observe(kept, f, y, seen);
    fit.solve(expected, y, seen);
    solved.states.col(f) = fit.x();
    for (int m = 0; m < M; ++m) {
      const auto i = kept.index(problem.first_frame + f, problem.data_marker[at(m)]);
      if (kept.state[i] != data::SampleState::rejected || !std::isfinite(expected.position_sd[m])) continue;
      filled.x(problem.first_frame + f, problem.data_marker[at(m)]) =
          model::point_in_world(fit.workspace(), model.markers()[at(m)].body, expected.position.col(m));
      filled.state[i] = data::SampleState::model_filled;
    }
  }
  return filled;
}

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

std::vector<Outlier> find_plain_defects(const Problem& problem, const data::Trajectories& markers,
                                        const SolvedFrames& solved) {
  std::vector<Outlier> found;
  find_held(problem, markers, solved, found);
  find_zero_coordinates(problem, markers, found);
  return found;
}

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

FollowedSamples judge_followed(const Problem& problem, const IkOptions& options,
                               const data::Trajectories& markers, const Eigen::MatrixXd& states,
                               const Array<data::FrameStatus>& status) {
  FollowedSamples found;
  if (!find_path_exchanges(problem, markers).empty()) return found;
  SolvedFrames followed;
  const Progress unseen;
  FrameWalk(problem, options, unseen).take(markers, states, status, followed);
  if (!find_plain_defects(problem, markers, followed).empty()) return found;
  const auto judgement = judge_recording(problem, options, markers, followed);
  found.solves = judgement.solves;
  found.all_explained = judgement.bad.empty() && judgement.doubtful.empty();
  return found;
}

}  // namespace kinemark::motion::internal

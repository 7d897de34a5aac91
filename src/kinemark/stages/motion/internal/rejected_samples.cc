// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/rejected_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/expected_pose_fit.h"

namespace kinemark::motion::internal {
namespace {

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

}  // namespace

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

}  // namespace kinemark::motion::internal

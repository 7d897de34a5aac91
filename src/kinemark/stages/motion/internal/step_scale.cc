// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/step_scale.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kSteps = 250;  // of one marker or speed that are used, at most
constexpr std::int64_t kPositionFrames =
    60;                                // frames from which the usual position of a marker is found, at most
constexpr double kShare = 0.8;         // quantile of absolute values that stands for the scale ...
constexpr double kShareInSd = 1.2816;  // ... which in a normal distribution lies here
constexpr double kRareShare = 0.94;    // and one for long tails: what a spike in a short trial does not reach
constexpr double kRareInSd = 1.8808;
constexpr double kMostOfUsual = 4.0;         // times the middle one of all markers: labels that always change
constexpr double kLeastPosition_m = 0.3e-3;  // no camera system steps by less
constexpr double kLeastSpeed = 1e-3;         // rad or m
constexpr double kMostCost =
    6.0;  // times that of a quarter of the frames: a frame that costs more is unusual
constexpr double kLeastCost_m2 = 1e-6;  // and by so much
constexpr int kLags = 9;                // 1 to 256 frames

struct Tails {
  double usual = 0.0, rare = 0.0;
  /// Standard deviation of what has tails like these.
  [[nodiscard]] double sd() const { return std::max(usual / kShareInSd, rare / kRareInSd); }
};

/// Quantiles of absolute values, which are reordered.
Tails tails_of(std::vector<double>& values) {
  if (values.empty()) return {};
  const auto rank = [&](double share) {
    return values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  };
  const auto rare = rank(kRareShare), usual = rank(kShare);
  std::nth_element(values.begin(), usual, values.end());
  std::nth_element(usual, rare, values.end());
  return {.usual = *usual, .rare = *rare};
}

std::int64_t stride_for(std::int64_t frames, std::int64_t most) {
  return std::max<std::int64_t>(1, frames / most);
}

Eigen::Vector3d position_at(const SolvedFrames& solved, Eigen::Index M, std::int64_t f, Eigen::Index m) {
  return Eigen::Map<const Eigen::Vector3f>(solved.positions.data() + 3 * (f * M + m)).cast<double>();
}

/// Scale of the steps of a marker's position over `lag` frames.
double step_over(const SolvedFrames& solved, const std::vector<std::uint8_t>& usual, Eigen::Index M,
                 Eigen::Index m, std::int64_t lag, std::vector<double>& values) {
  const std::int64_t F = solved.states.cols();
  values.clear();
  for (std::int64_t f = lag; f < F; f += stride_for(F - lag, kSteps)) {
    if (!usual[at(f)] || !usual[at(f - lag)]) continue;
    const Eigen::Vector3d step = position_at(solved, M, f, m) - position_at(solved, M, f - lag, m);
    if (std::isnan(step.x())) continue;
    for (int axis = 0; axis < 3; ++axis) values.push_back(std::abs(step[axis]));
  }
  return tails_of(values).sd();
}

}  // namespace

StepScale::StepScale(const Problem& problem, const SolvedFrames& solved)
    : problem_(problem), solved_(solved) {
  find_usual();
  learn_positions();
  learn_speeds();
}

// A long stretch of bad samples spoils the poses of its frames, and shows in what they cost.
void StepScale::find_usual() {
  std::vector<double> costs;
  for (std::int64_t f = 0; f < problem_.frames; f += stride_for(problem_.frames, kSteps))
    if (solved_.status[at(f)] != data::FrameStatus::no_markers) costs.push_back(solved_.cost[at(f)]);
  usual_.assign(at(problem_.frames), 1);
  if (costs.empty()) return;
  const double most = kMostCost * math::quantile(costs, 0.25) + kLeastCost_m2;
  for (std::int64_t f = 0; f < problem_.frames; ++f) usual_[at(f)] = solved_.cost[at(f)] <= most;
}

double StepScale::position_sd_after(Eigen::Index marker, std::int64_t frames) {
  if (frames <= 1) return position[marker];
  learn_growth();
  std::size_t i = 0;
  while (i + 1 < growth_.size() && (std::int64_t{1} << i) < frames) ++i;
  return std::min(position[marker] * growth_[i], std::max(spread[marker], 2.0 * position[marker]));
}

void StepScale::learn_positions() {
  const Eigen::Index M = problem_.model.marker_count();
  const std::int64_t F = problem_.frames;
  position.setZero(M);
  spread.setZero(M);
  centre.setZero(3, M);
  std::vector<double> values, distances;
  for (Eigen::Index m = 0; m < M; ++m) {
    position[m] = std::max(kLeastPosition_m, step_over(solved_, usual_, M, m, 1, values));
    distances.clear();
    for (int axis = 0; axis < 3; ++axis) {
      values.clear();
      for (std::int64_t f = 0; f < F; f += stride_for(F, kPositionFrames))
        if (const double u = position_at(solved_, M, f, m)[axis]; usual_[at(f)] && !std::isnan(u))
          values.push_back(u);
      if (values.empty()) continue;
      centre(axis, m) = math::upper_median(values);
      for (const double u : values) distances.push_back(std::abs(u - centre(axis, m)));
    }
    spread[m] = std::max(position[m], tails_of(distances).sd());
  }
  for (auto* v : {&position, &spread}) {
    const double middle = math::upper_median({v->data(), at(M)});
    *v = v->cwiseMin(kMostOfUsual * middle);
  }
}

void StepScale::learn_growth() {
  if (!growth_.empty()) return;
  const Eigen::Index M = problem_.model.marker_count();
  std::vector<double> values, ratios;
  growth_.assign(1, 1.0);
  for (int i = 1; i < kLags && (std::int64_t{1} << i) < problem_.frames; ++i) {
    ratios.clear();
    for (Eigen::Index m = 0; m < M; ++m)
      ratios.push_back(step_over(solved_, usual_, M, m, std::int64_t{1} << i, values) / position[m]);
    growth_.push_back(std::max(growth_.back(), math::upper_median(ratios)));
  }
}

// A step, and what it differs by from the one before: first and second difference of the state.
void StepScale::learn_speeds() {
  const Eigen::Index n = problem_.model.speed_count();
  const std::int64_t F = problem_.frames;
  for (auto* v : {&speed, &rare, &stride}) v->setConstant(n, kLeastSpeed);
  if (F < 3) return;
  std::vector<std::vector<double>> changes(at(n)), steps(at(n));
  Eigen::VectorXd before(n), after(n);
  for (std::int64_t f = 1; f + 1 < F; f += stride_for(F, kSteps)) {
    if (!usual_[at(f - 1)] || !usual_[at(f)] || !usual_[at(f + 1)]) continue;
    model::difference(problem_.model, solved_.states.col(f - 1), solved_.states.col(f), before);
    model::difference(problem_.model, solved_.states.col(f), solved_.states.col(f + 1), after);
    for (Eigen::Index i = 0; i < n; ++i) {
      changes[at(i)].push_back(std::abs(after[i] - before[i]));
      steps[at(i)].push_back(std::abs(after[i]));
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Tails change = tails_of(changes[at(i)]);
    speed[i] = std::max(kLeastSpeed, change.sd());
    rare[i] = std::max(kLeastSpeed, change.rare);
    stride[i] = std::max(kLeastSpeed, tails_of(steps[at(i)]).sd());
  }
  // What rests at a limit most of the time may leave it.
  for (auto* v : {&speed, &rare, &stride}) {
    const double middle = math::upper_median({v->data(), at(n)});
    *v = v->cwiseMax(middle);
  }
}

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/scatter.h"

#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::int64_t kGrain = 64;
constexpr double kBlind = 1.0;   // rad^2 or m^2: nothing is known of an angle this uncertain
constexpr double kChance = 3.0;  // deviations of the chi-square of a joint that keeps still

}  // namespace

MatrixXd posture_variances(const Problem& problem, const GeometryLayout& layout,
                           const data::Trajectories& markers, const MatrixXd& states, int threads) {
  const Index speeds = problem.model.speed_count();
  MatrixXd variances = MatrixXd::Constant(speeds, states.cols(), std::numeric_limits<double>::infinity());
  parallel_for(problem.frames, kGrain, threads, [&](std::int64_t begin, std::int64_t end) {
    FrameEquations frame(problem, layout);
    Eigen::Matrix3Xd y(3, problem.model.marker_count());
    VectorXd weight(problem.model.marker_count());
    MatrixXd half(speeds, speeds);
    for (std::int64_t f = begin; f < end; ++f) {
      problem.observe(markers, f, y, weight);
      if (weight.sum() == 0.0) continue;
      frame.visit(y, weight, states.col(f));
      half.setIdentity();
      frame.llt.matrixL().solveInPlace(half);
      variances.col(f) = half.colwise().squaredNorm().transpose();
      for (Index i = 0; i < speeds; ++i)
        if (problem.fixed_speed[at(i)]) variances(i, f) = 0.0;
    }
  });
  return variances;
}

Scatter measure_scatter(const VectorXd& angles, const VectorXd& variances) {
  double weights = 0.0, sum = 0.0, seen = 0.0;
  const auto weight_of = [&](Index f) {
    return variances[f] > 0.0 && variances[f] < kBlind ? 1.0 / variances[f] : 0.0;
  };
  for (Index f = 0; f < angles.size(); ++f) {
    const double weight = weight_of(f);
    if (weight == 0.0) continue;
    weights += weight;
    sum += weight * angles[f];
    seen += 1.0;
  }
  Scatter out;
  if (seen < 2.0) return out;
  out.mean = sum / weights;
  double chi_square = 0.0;
  for (Index f = 0; f < angles.size(); ++f)
    if (const double weight = weight_of(f); weight > 0.0)
      chi_square += weight * std::pow(angles[f] - out.mean, 2) / (seen - 1.0);
  const bool still = chi_square <= 1.0 + kChance * std::sqrt(2.0 / (seen - 1.0));
  out.motion = still ? 0.0 : std::sqrt(1.0 - 1.0 / chi_square);
  return out;
}

Quiet Quiet::measure(const Problem& problem, const GeometryLayout& layout, const data::Trajectories& markers,
                     const MatrixXd& states, double noise_sd_m, int threads) {
  Quiet quiet;
  quiet.variances_ = noise_sd_m * noise_sd_m * posture_variances(problem, layout, markers, states, threads);
  quiet.motion_.setOnes(problem.model.coordinate_count());
  for (Index c = 0; c < quiet.motion_.size(); ++c)
    if (const auto& coordinate = problem.model.coordinates()[at(c)]; coordinate.speed_idx >= 0)
      quiet.motion_[c] = measure_scatter(states.row(coordinate.state_idx).transpose(),
                                         quiet.variances_.row(coordinate.speed_idx).transpose())
                             .motion;
  return quiet;
}

MatrixXd Quiet::apply(const Problem& problem, const MatrixXd& states) const {
  MatrixXd quiet = states;
  for (Index c = 0; c < motion_.size(); ++c) {
    if (motion_[c] == 1.0) continue;
    const auto& coordinate = problem.model.coordinates()[at(c)];
    const VectorXd angles = states.row(coordinate.state_idx).transpose();
    const double mean = measure_scatter(angles, variances_.row(coordinate.speed_idx).transpose()).mean;
    quiet.row(coordinate.state_idx) = (mean + motion_[c] * (angles.array() - mean)).matrix().transpose();
  }
  return quiet;
}

}  // namespace kinemark::motion::internal

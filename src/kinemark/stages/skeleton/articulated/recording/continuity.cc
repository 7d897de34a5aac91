// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/continuity.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/parallel.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;

constexpr double kLead = 4.605170185988092;  // log 100
constexpr double kFarthest = 25.0;           // squared distance from the path, in SDs
constexpr double kLooseEnds_m = 0.015;       // path known worse than this does not fill in a frame
constexpr std::int64_t kGrain = 256;         // flagged frames a chunk
constexpr double kWeakest = 1e-6;            // of a joint's information, relative

/// A joint's position in one frame as its path predicts it, the frame itself not having been used.
struct PredictedJoint {
  bool known = false;
  Vector3d position = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Zero();  ///< of the path
  Matrix3d inverse = Matrix3d::Zero();     ///< of path and noise together, for distances
};

std::vector<PredictedJoint> predict_joints(const Continuity& continuity, std::size_t frame,
                                           double noise_sd_m) {
  std::vector<PredictedJoint> out(continuity.path.size());
  for (std::size_t j = 0; j < out.size(); ++j) {
    const SmoothedPath& path = continuity.path[j];
    if (path.position.empty() || !path.known(frame)) continue;
    out[j].known = true;
    out[j].position = path.position[frame];
    out[j].covariance = path.covariance_at(frame);
    const double slack = 4.0 * noise_sd_m * noise_sd_m;
    out[j].inverse = (out[j].covariance + slack * Matrix3d::Identity()).inverse();
  }
  return out;
}

double squared_distance(const Vector3d& x, const PredictedJoint& path) {
  const Vector3d d = x - path.position;
  return d.dot(path.inverse * d);
}

/// The mode that data and paths prefer together, or -1 when for some joint that is to be chosen another
/// position comes close to it or the path lies elsewhere.
int choose(const FlaggedFrame& flagged, const std::vector<PredictedJoint>& paths,
           const std::vector<bool>& chosen, double noise_sd_m) {
  const std::size_t n = flagged.modes.size();
  if (n == 0) return -1;
  std::vector<double> score(n);
  for (std::size_t i = 0; i < n; ++i) {
    score[i] = flagged.modes[i].log_weight;
    for (std::size_t j = 0; j < paths.size(); ++j)
      if (paths[j].known) score[i] -= 0.5 * squared_distance(flagged.modes[i].centre[j], paths[j]);
  }
  const auto best = static_cast<std::size_t>(std::ranges::max_element(score) - score.begin());
  for (std::size_t j = 0; j < paths.size(); ++j) {
    if (!chosen[j]) continue;
    if (!paths[j].known) return -1;
    const Vector3d& position = flagged.modes[best].centre[j];
    if (squared_distance(position, paths[j]) > kFarthest) return -1;
    for (std::size_t i = 0; i < n; ++i) {
      const bool same = (flagged.modes[i].centre[j] - position).norm() < 0.2 * noise_sd_m;
      if (i != best && !same && score[i] > score[best] - kLead) return -1;
    }
  }
  return static_cast<int>(best);
}

/// What a frame that was solved with `prior` about the joint adds to it: the position that its own markers
/// prefer.
PathPoint without_prior(const Vector3d& centre, const Matrix3d& information, const Matrix3d& prior,
                        const Vector3d& target) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(information);
  const double weakest = kWeakest * std::max(eigen.eigenvalues()[2], 0.0);
  PathPoint point{.position = centre};
  const Vector3d gradient = prior * (centre - target);
  for (int i = 0; i < 3; ++i) {
    const double w = eigen.eigenvalues()[i];
    if (w <= weakest) continue;
    const Vector3d v = eigen.eigenvectors().col(i);
    point.information += w * v * v.transpose();
    point.position += v.dot(gradient) / w * v;
  }
  return point;
}

class Bridge {
 public:
  Bridge(const FittedChain& fit, const ChainSamples& samples, const Continuity& continuity,
         RecordingPass& pass)
      : fit_(fit), samples_(samples), continuity_(continuity), pass_(pass), solver_(fit) {}

  void cross(const FlaggedFrame& flagged) {
    const auto k = static_cast<std::size_t>(flagged.frame);
    const std::size_t J = pass_.points.size();
    const auto paths = predict_joints(continuity_, k, fit_.noise_sd_m);
    // Where several positions together determine a joint, the path may still tell them apart.
    std::vector<bool> open(J), chosen(J);
    for (std::size_t j = 0; j < J; ++j) {
      open[j] = pass_.state[j][k] != CentreState::determined;
      chosen[j] = open[j] || flagged.gathered[j] != 0;
    }
    const double* x = samples_.frame(flagged.frame);
    const int mode = has_open_curve(k, open) ? -1 : choose(flagged, paths, chosen, fit_.noise_sd_m);
    if (mode >= 0) {
      solver_.pose_from_centres(x, flagged.modes[static_cast<std::size_t>(mode)].centre, pose_);
      const double cost = solver_.solve_near(x, pose_, {}, frame_);
      for (std::size_t j = 0; j < J; ++j)
        if (chosen[j] && accept(cost, j, paths[j]))
          pass_.points[j][k] = {.position = frame_.centre[j], .information = frame_.information[j]};
      return;
    }
    const bool any_open = std::ranges::find(open, true) != open.end();
    if (any_open && shows_enough(flagged.frame)) fill_in(x, k, paths, open);
  }

 private:
  /// A joint that no mode determines: it may lie anywhere on a curve or in space.
  [[nodiscard]] bool has_open_curve(std::size_t frame, const std::vector<bool>& open) const {
    for (std::size_t j = 0; j < open.size(); ++j)
      if (open[j] && pass_.state[j][frame] == CentreState::undetermined) return true;
    return false;
  }

  [[nodiscard]] bool accept(double cost, std::size_t joint, const PredictedJoint& path) const {
    return path.known && !is_misfit(fit_.chain, cost, fit_.noise_sd_m, frame_.seen) &&
           squared_distance(frame_.centre[joint], path) < kFarthest;
  }

  /// Two markers at least: one would only return the path's own prediction.
  [[nodiscard]] bool shows_enough(std::int64_t frame) const {
    int seen = 0;
    for (int m = 0; m < samples_.markers; ++m) seen += samples_.seen(frame, m) ? 1 : 0;
    return seen >= 2;
  }

  void fill_in(const double* x, std::size_t k, const std::vector<PredictedJoint>& paths,
               const std::vector<bool>& open) {
    const std::size_t J = paths.size();
    const double noise2 = fit_.noise_sd_m * fit_.noise_sd_m;
    priors_.clear();
    centres_.assign(J, Vector3d::Zero());
    std::vector<Matrix3d> weight(J, Matrix3d::Zero());
    for (std::size_t j = 0; j < J; ++j) {
      if (!paths[j].known) return;
      centres_[j] = paths[j].position;
      if (!open[j]) continue;
      // A thousandth of the noise more, so that a path known exactly does not make the problem singular.
      weight[j] = (paths[j].covariance + 1e-3 * noise2 * Matrix3d::Identity()).inverse();
      priors_.push_back(
          {.joint = static_cast<int>(j), .target = paths[j].position, .weight = noise2 * weight[j]});
    }
    solver_.pose_from_centres(x, centres_, pose_);
    const double cost = solver_.solve_near(x, pose_, priors_, frame_);
    for (std::size_t j = 0; j < J; ++j) {
      if (!open[j] || !accept(cost, j, paths[j]) || paths[j].covariance.trace() > kLooseEnds_m * kLooseEnds_m)
        continue;
      pass_.points[j][k] =
          without_prior(frame_.centre[j], frame_.information[j], weight[j], paths[j].position);
    }
  }

  const FittedChain& fit_;
  const ChainSamples& samples_;
  const Continuity& continuity_;
  RecordingPass& pass_;
  ChainSolver solver_;
  ChainFrame frame_;
  ChainPose pose_;
  std::vector<JointPrior> priors_;
  std::vector<Vector3d> centres_;
};

}  // namespace

Continuity follow_paths(const FittedChain& fit, const ChainSamples& samples, double rate_hz, int threads,
                        RecordingPass& pass) {
  const std::size_t J = pass.points.size();
  Continuity continuity{.prior = std::vector<PathPrior>(J), .path = std::vector<SmoothedPath>(J)};
  for (std::size_t j = 0; j < J; ++j) {
    if (std::ranges::count_if(pass.points[j], holds_a_position) < kLeastFollowed) continue;
    continuity.prior[j] = find_path_prior(pass.points[j], rate_hz);
    if (continuity.prior[j].follows)
      continuity.path[j] = smooth_path(pass.points[j], rate_hz, continuity.prior[j].white_jerk);
  }
  const auto count = static_cast<std::int64_t>(pass.flagged.size());
  parallel_for(count, kGrain, threads, [&](std::int64_t begin, std::int64_t end) {
    Bridge bridge(fit, samples, continuity, pass);
    for (std::int64_t i = begin; i < end; ++i) bridge.cross(pass.flagged[static_cast<std::size_t>(i)]);
  });
  for (std::size_t j = 0; j < J; ++j)
    if (continuity.prior[j].follows && count > 0)
      continuity.path[j] = smooth_path(pass.points[j], rate_hz, continuity.prior[j].white_jerk);
  return continuity;
}

}  // namespace kinemark::skeleton::articulated

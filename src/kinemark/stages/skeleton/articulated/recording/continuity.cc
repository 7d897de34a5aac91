// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/continuity.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
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
constexpr double kStranger = 30.0;           // squared SDs of three directions: one in a million by chance
constexpr std::ptrdiff_t kNext = 2;          // frames: where these stand aside too, the path is abrupt
constexpr int kRounds = 4;                   // in which strangers leave
constexpr double kBeside_s = 0.2;            // about a stranger, in which others seem to be ones too

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

/// Squared distance of every frame's position from where all others point, in SDs of both; 0 where it holds
/// none.
std::vector<double> distances_from_others(const std::vector<PathPoint>& points, const SmoothedPath& path) {
  std::vector<double> far(points.size(), 0.0);
  for (std::size_t f = 0; f < points.size(); ++f) {
    if (!path.known(f)) continue;
    const Others others = without_frame(points[f], path.position[f], path.covariance_at(f));
    if (others.known) far[f] = others.distance(points[f].position);
  }
  return far;
}

/// The largest of the distances about a frame.
double farthest_about(const std::vector<double>& far, std::ptrdiff_t frame, std::ptrdiff_t beside) {
  return *std::max_element(far.begin() + std::max<std::ptrdiff_t>(0, frame - beside),
                           far.begin() + std::min(std::ssize(far), frame + beside + 1));
}

/// Frames whose position lies beyond kStranger from where all others point, each the farthest about it: a
/// wrong one makes its neighbours seem wrong. Those that were tried before are left out.
std::vector<std::size_t> strangers_of(const std::vector<double>& far, const std::vector<bool>& tried,
                                      double rate_hz) {
  const auto beside = std::max<std::ptrdiff_t>(1, std::lround(kBeside_s * rate_hz));
  std::vector<std::size_t> out;
  for (std::ptrdiff_t f = 0; f < std::ssize(far); ++f)
    if (far[at(f)] > kStranger && !tried[at(f)] && far[at(f)] == farthest_about(far, f, beside))
      out.push_back(at(f));
  return out;
}

/// The frame determines nothing: the position that it shows is not the joint's.
void doubt(std::size_t frame, std::size_t joint, RecordingPass& pass) {
  pass.points[joint][frame].information.setZero();
  pass.state[joint][frame] = CentreState::ambiguous;
  const auto f = static_cast<std::int64_t>(frame);
  const auto place = std::ranges::lower_bound(pass.flagged, f, {}, &FlaggedFrame::frame);
  if (place == pass.flagged.end() || place->frame != f)
    pass.flagged.insert(place, {.frame = f, .modes = {}, .gathered = std::vector<char>(pass.points.size())});
}

/// Smooths a joint's path without single frames that stand against all others. Where the next frames stand
/// aside with one it is the movement that is abrupt, and all are kept.
void smooth_without_strangers(std::size_t joint, double rate_hz, RecordingPass& pass, const PathPrior& prior,
                              SmoothedPath& path) {
  auto& points = pass.points[joint];
  std::vector<bool> tried(points.size(), false);
  path = smooth_path(points, rate_hz, prior.white_jerk);
  auto far = distances_from_others(points, path);
  for (int round = 0; round < kRounds; ++round) {
    const auto found = strangers_of(far, tried, rate_hz);
    if (found.empty()) return;
    std::vector<Matrix3d> information;
    for (const std::size_t f : found) {
      tried[f] = true;
      information.push_back(points[f].information);
      points[f].information.setZero();
    }
    path = smooth_path(points, rate_hz, prior.white_jerk);
    far = distances_from_others(points, path);
    bool restored = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto f = static_cast<std::ptrdiff_t>(found[i]);
      if (farthest_about(far, f, kNext) <= kStranger) {
        doubt(found[i], joint, pass);
        continue;
      }
      points[found[i]].information = information[i];
      for (auto k = std::max<std::ptrdiff_t>(0, f - kNext); k <= std::min(std::ssize(far) - 1, f + kNext);
           ++k)
        tried[at(k)] = true;
      restored = true;
    }
    if (!restored) continue;
    path = smooth_path(points, rate_hz, prior.white_jerk);
    far = distances_from_others(points, path);
  }
}

}  // namespace

Continuity follow_paths(const FittedChain& fit, const ChainSamples& samples, double rate_hz, int threads,
                        RecordingPass& pass) {
  const std::size_t J = pass.points.size();
  Continuity continuity{.prior = std::vector<PathPrior>(J), .path = std::vector<SmoothedPath>(J)};
  for (std::size_t j = 0; j < J; ++j) {
    if (std::ranges::count_if(pass.points[j], holds_a_position) < kLeastFollowed) continue;
    continuity.prior[j] = find_path_prior(pass.points[j], rate_hz);
    if (continuity.prior[j].follows)
      smooth_without_strangers(j, rate_hz, pass, continuity.prior[j], continuity.path[j]);
  }
  const auto count = static_cast<std::int64_t>(pass.flagged.size());
  parallel_for(count, kGrain, threads, [&](std::int64_t begin, std::int64_t end) {
    Bridge bridge(fit, samples, continuity, pass);
    for (std::int64_t i = begin; i < end; ++i) bridge.cross(pass.flagged[static_cast<std::size_t>(i)]);
  });
  for (std::size_t j = 0; j < J; ++j)
    if (continuity.prior[j].follows && count > 0)
      smooth_without_strangers(j, rate_hz, pass, continuity.prior[j], continuity.path[j]);
  return continuity;
}

}  // namespace kinemark::skeleton::articulated

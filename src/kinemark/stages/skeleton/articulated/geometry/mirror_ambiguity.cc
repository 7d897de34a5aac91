// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/mirror_ambiguity.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

constexpr std::size_t kMirrorFrames = 150;
constexpr double kEnoughFrames = 40.0;
constexpr int kFirstLook = 3, kSecondLook = 6;  // steps of a fit after which it may be given up
constexpr double kGainsLeft = 100.0;            // a fit gains no more than so many times its last step
constexpr double kLeastGain = 0.1;              // chi-square of a fit's last step
constexpr double kFarWorse = 1000.0;            // chi-square above the best: no mirror image
constexpr double kWideSd = 50.0;         // second extent of a segment's markers over the noise, chi-square
constexpr double kRotatesEnough = 0.05;  // least eigenvalue over its largest possible value

// Reflect a segment's joint (or its origin) at the plane that lies best through its markers.
void mirror_joint(Chain& chain, int joint, bool in_parent) {
  const int s = in_parent ? chain.layout.parent[joint] : joint + 1;
  const std::vector<int> markers = chain.layout.markers_of(s);
  if (markers.size() < 3) return;
  Vector3d mean = Vector3d::Zero();
  for (const int k : markers) mean += chain.marker.col(k);
  mean /= static_cast<double>(markers.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const int k : markers) {
    const Vector3d d = chain.marker.col(k) - mean;
    scatter += d * d.transpose();
  }
  const Vector3d normal = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0);
  const bool at_origin = !in_parent || joint == 0;
  const Vector3d p = at_origin ? Vector3d::Zero() : Vector3d(chain.joint.col(joint));
  move_joint(chain, joint, in_parent, -2.0 * normal.dot(p - mean) * normal);
}

// True where enough frames show both segments' poses and these rotate against each other about more than one
// axis: the joint then follows from a linear system and has no mirror ambiguity. The least eigenvalue of sum
// |R_a p_a - R_b p_b|^2 is n - |sum R_a^T R_b|.
bool is_unambiguous(const ChainSamples& samples, const PosedFrames& frames, const FittedChain& fit,
                    int joint) {
  PoseSolver solver(fit.chain);
  const int parent = fit.chain.layout.parent[joint];
  const int child = joint + 1;
  const auto wide = [&](int s) {
    const FrameSums::Segment& sum = solver.sums().segment[s];
    if (sum.seen < 3) return false;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(sum.mm - sum.m * sum.m.transpose() / sum.w,
                                                       Eigen::EigenvaluesOnly);
    return axes.eigenvalues()[1] > kWideSd * fit.noise_sd_m * fit.noise_sd_m;
  };
  Matrix3d relative = Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    solver.set(samples.frame(frames.frame[i]), fit.marker_weight);
    if (!wide(parent) || !wide(child)) continue;
    relative += frames.pose[i].rotation[parent].transpose() * frames.pose[i].rotation[child];
    count += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> squares(relative.transpose() * relative,
                                                        Eigen::EigenvaluesOnly);
  return count >= kEnoughFrames && count - std::sqrt(squares.eigenvalues()[2]) > kRotatesEnough * count;
}

double joint_distance(const Chain& a, const PosedFrames& in_a, const Chain& b, const PosedFrames& in_b,
                      int joint) {
  double sum = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    sum += (a.joint_centre(in_a.pose[i], joint) - b.joint_centre(in_b.pose[i], joint)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(in_a.size()));
}

}  // namespace

bool try_mirrored(const ChainSamples& samples, const PosedFrames& frames, FittedChain& fit, int threads) {
  fit.mirror_margin = std::numeric_limits<double>::infinity();
  std::vector<int> open;
  for (int j = 0; j < fit.chain.joints(); ++j) {
    if (!is_unambiguous(samples, frames, fit, j)) open.push_back(j);
  }
  if (open.empty()) return false;
  std::vector<std::int64_t> some;
  const std::size_t n = std::min(frames.size(), kMirrorFrames);
  for (std::size_t i = 0; i < n; ++i) some.push_back(frames.frame[i * frames.size() / n]);
  const double variance = fit.noise_sd_m * fit.noise_sd_m;
  bool taken = false;
  const double share = static_cast<double>(frames.size()) / static_cast<double>(n);
  const auto refit = [&](Chain& chain, PosedFrames& poses, double best) {
    poses = first_poses(samples, chain, some, fit.marker_weight, fit.noise_sd_m, 15, threads);
    GeometryFit geometry(chain, samples, poses, fit.noise_sd_m, threads);
    return geometry.run(10, {}, [&](int round, double gain_m2) {
      if (gain_m2 < kLeastGain * variance) return true;
      if (round != kFirstLook && round != kSecondLook) return false;
      return geometry.cost() - kGainsLeft * gain_m2 > best + kFarWorse * variance;
    });
  };
  Chain best = fit.chain;
  PosedFrames best_poses;
  double best_cost = refit(best, best_poses, std::numeric_limits<double>::infinity());
  for (const int j : open) {
    const bool parent_solid = fit.chain.kind[fit.chain.layout.parent[j]] == SegmentKind::solid;
    const bool child_solid = fit.chain.kind[j + 1] == SegmentKind::solid;
    for (const int which : {1, 2, 3}) {
      if (((which & 1) != 0 && !parent_solid) || ((which & 2) != 0 && !child_solid)) continue;
      Chain mirrored = best;
      if ((which & 1) != 0) mirror_joint(mirrored, j, true);
      if ((which & 2) != 0) mirror_joint(mirrored, j, false);
      PosedFrames poses;
      const double cost = refit(mirrored, poses, best_cost);
      if (joint_distance(best, best_poses, mirrored, poses, j) < 2.0 * fit.noise_sd_m) continue;
      const double margin = share * (cost - best_cost) / variance;
      fit.mirror_margin = std::min(fit.mirror_margin, std::abs(margin));
      if (margin >= 0.0) continue;
      best = mirrored;
      best_poses = poses;
      best_cost = cost;
      taken = true;
    }
  }
  if (taken) fit.chain = best;
  return taken;
}

}  // namespace kinemark::skeleton::articulated

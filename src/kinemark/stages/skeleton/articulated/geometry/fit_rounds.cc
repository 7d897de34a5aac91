// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/fit_rounds.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/articulated/frame/modes.h"

namespace kinemark::skeleton {

namespace {

using data::SegmentKind;

constexpr std::size_t kTwinFrames = 150;
constexpr std::size_t kEnoughFrames = 40;
constexpr double kWideSd = 50.0;  // second extent of a segment's markers over the noise, chi-square
constexpr double kTurned = 0.05;  // of the most that two segments can turn against each other

// Move a joint in the axes of its parent or of its child.
void move_joint(Chain& chain, int joint, bool in_parent, const Vector3d& change) {
  if (in_parent && joint > 0) {
    chain.joint.col(joint) += change;
    return;
  }
  // The origin moves: everything else moves the other way.
  const int s = in_parent ? chain.layout.parent[joint] : joint + 1;
  for (const int k : chain.layout.markers_of(s)) chain.marker.col(k) -= change;
  for (int j = 1; j < chain.joints(); ++j) {
    if (chain.layout.parent[j] == s) chain.joint.col(j) -= change;
  }
}

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

// Where most frames show both segments' poses, and these turn against each other about more than one axis,
// the joint follows from a linear system: no twin. sum |R_a p_a - R_b p_b|^2 has least eigenvalue n - |sum
// R_a^T R_b|.
bool surely_alone(const ChainSamples& samples, const GlobalFrames& frames, const ChainFit& fit, int joint) {
  FrameSolver solver(fit.chain);
  const int parent = fit.chain.layout.parent[joint];
  const int child = joint + 1;
  const auto wide = [&](int s) {
    const FrameSums::Segment& sum = solver.sums().segment[s];
    if (sum.seen < 3) return false;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(sum.mm - sum.m * sum.m.transpose() / sum.w,
                                                       Eigen::EigenvaluesOnly);
    return axes.eigenvalues()[1] > kWideSd * fit.noise_sd_m * fit.noise_sd_m;
  };
  Matrix3d turns = Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    solver.set(samples.frame(frames.frame[i]), fit.marker_weight);
    if (!wide(parent) || !wide(child)) continue;
    turns += frames.pose[i].rotation[parent].transpose() * frames.pose[i].rotation[child];
    count += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> squares(turns.transpose() * turns, Eigen::EigenvaluesOnly);
  return count >= static_cast<double>(kEnoughFrames) &&
         count - std::sqrt(squares.eigenvalues()[2]) > kTurned * count;
}

double joint_distance(const Chain& a, const GlobalFrames& in_a, const Chain& b, const GlobalFrames& in_b,
                      int joint) {
  double sum = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    sum += (a.joint_centre(in_a.pose[i], joint) - b.joint_centre(in_b.pose[i], joint)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(in_a.size()));
}

}  // namespace

ChainSamples thin_out(const ChainSamples& samples, int most, std::vector<std::int64_t>& kept) {
  std::vector<std::int64_t> useful;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    int seen = 0;
    for (int k = 0; k < samples.markers && seen < 2; ++k) seen += samples.seen(f, k) ? 1 : 0;
    if (seen >= 2) useful.push_back(f);
  }
  kept.clear();
  const auto n = static_cast<std::int64_t>(useful.size());
  const std::int64_t take = std::min<std::int64_t>(n, most);
  ChainSamples out;
  out.markers = samples.markers;
  out.frames = take;
  out.x.resize(static_cast<std::size_t>(3 * take * samples.markers));
  for (std::int64_t i = 0; i < take; ++i) {
    kept.push_back(useful[i * n / take]);
    std::copy_n(samples.frame(kept.back()), 3 * samples.markers, out.x.data() + 3 * i * samples.markers);
  }
  return out;
}

std::vector<std::int64_t> first_frames(const ChainSamples& samples, const Chain& chain) {
  std::vector<int> have(chain.segments(), 0);
  for (const int s : chain.layout.segment_of_marker) ++have[s];
  std::vector<std::int64_t> full;
  std::vector<std::int64_t> some;
  std::vector<std::int64_t> few;
  const bool lines =
      chain.segments() == 2 && chain.kind[0] == SegmentKind::line && chain.kind[1] == SegmentKind::line;
  std::vector<int> seen(chain.segments());
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    std::fill(seen.begin(), seen.end(), 0);
    for (int k = 0; k < samples.markers; ++k)
      seen[chain.layout.segment_of_marker[k]] += samples.seen(f, k) ? 1 : 0;
    bool all_whole = true;
    bool all_two = true;
    bool all_one = true;
    bool one_whole = false;
    for (int s = 0; s < chain.segments(); ++s) {
      const bool whole = seen[s] >= std::min(chain.kind[s] == SegmentKind::line ? 2 : 3, have[s]);
      all_whole = all_whole && whole;
      all_two = all_two && seen[s] >= std::min(2, have[s]);
      all_one = all_one && seen[s] >= 1;
      one_whole = one_whole || (whole && have[s] > 1);
    }
    if (all_whole) full.push_back(f);
    if (one_whole && all_two) some.push_back(f);
    if (one_whole && (all_one || lines)) few.push_back(f);
  }
  if (lines) return few;
  if (full.size() >= kEnoughFrames) return full;
  return some.size() >= kEnoughFrames / 2 ? some : few;
}

GlobalFrames first_poses(const ChainSamples& samples, const Chain& chain,
                         const std::vector<std::int64_t>& frames, const std::vector<double>& marker_weight,
                         double sigma_m, int iterations) {
  GlobalFrames out;
  FrameSolver solver(chain);
  ModeFinder finder(chain);
  std::vector<ChainMode> modes;
  for (const std::int64_t f : frames) {
    solver.set(samples.frame(f), marker_weight);
    if (finder.find(solver, samples.frame(f), sigma_m, nullptr, iterations, modes) == 0) continue;
    out.frame.push_back(f);
    out.pose.push_back(modes[0].pose);
    out.weight.push_back(marker_weight);
  }
  return out;
}

bool try_twins(const ChainSamples& samples, const GlobalFrames& frames, ChainFit& fit) {
  fit.twin_margin = std::numeric_limits<double>::infinity();
  std::vector<int> open;
  for (int j = 0; j < fit.chain.joints(); ++j) {
    if (!surely_alone(samples, frames, fit, j)) open.push_back(j);
  }
  if (open.empty()) return false;
  std::vector<std::int64_t> some;
  const std::size_t n = std::min(frames.size(), kTwinFrames);
  for (std::size_t i = 0; i < n; ++i) some.push_back(frames.frame[i * frames.size() / n]);
  const double variance = fit.noise_sd_m * fit.noise_sd_m;
  bool taken = false;
  const double share = static_cast<double>(frames.size()) / static_cast<double>(n);
  const auto refit = [&](Chain& chain, GlobalFrames& poses) {
    poses = first_poses(samples, chain, some, fit.marker_weight, fit.noise_sd_m, 15);
    return GlobalFit(chain, samples, poses, fit.noise_sd_m).run(10);
  };
  Chain best = fit.chain;
  GlobalFrames best_poses;
  double best_cost = refit(best, best_poses);
  for (const int j : open) {
    const bool parent_solid = fit.chain.kind[fit.chain.layout.parent[j]] == SegmentKind::solid;
    const bool child_solid = fit.chain.kind[j + 1] == SegmentKind::solid;
    for (const int which : {1, 2, 3}) {
      if (((which & 1) != 0 && !parent_solid) || ((which & 2) != 0 && !child_solid)) continue;
      Chain twin = best;
      if ((which & 1) != 0) mirror_joint(twin, j, true);
      if ((which & 2) != 0) mirror_joint(twin, j, false);
      GlobalFrames poses;
      const double cost = refit(twin, poses);
      if (joint_distance(best, best_poses, twin, poses, j) < 2.0 * fit.noise_sd_m) continue;
      const double margin = share * (cost - best_cost) / variance;
      fit.twin_margin = std::min(fit.twin_margin, std::abs(margin));
      if (margin >= 0.0) continue;
      best = twin;
      best_poses = poses;
      best_cost = cost;
      taken = true;
    }
  }
  if (taken) fit.chain = best;
  return taken;
}

void hold_hinges(const ChainSamples& samples, const std::vector<HingeAxis>& hinges, ChainFit& fit) {
  for (const HingeAxis& hinge : hinges) {
    const double above = hinge.in_parent.dot(joint_from_markers(fit.chain, hinge.joint, true));
    const double below = hinge.in_child.dot(joint_from_markers(fit.chain, hinge.joint, false));
    const double along = -0.5 * (above + below);
    move_joint(fit.chain, hinge.joint, true, along * hinge.in_parent);
    move_joint(fit.chain, hinge.joint, false, along * hinge.in_child);
  }
  GlobalFrames frames = first_poses(samples, fit.chain, fit.frames, fit.marker_weight, fit.noise_sd_m, 25);
  GlobalFit globals(fit.chain, samples, frames, fit.noise_sd_m);
  globals.hold(hinges);
  globals.run(20);
  if (fit.robust_dof > 0.0) {
    globals.reweigh(fit.marker_weight, fit.robust_dof, fit.noise_sd_m);
    globals.run(10);
  }
  fit.global_covariance =
      fit.global_covariance_scale * fit.noise_sd_m * fit.noise_sd_m * globals.covariance(fit.noise_sd_m);
}

}  // namespace kinemark::skeleton

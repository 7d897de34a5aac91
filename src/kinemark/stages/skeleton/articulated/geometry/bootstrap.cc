// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"

namespace kinemark::skeleton::articulated {
namespace {

constexpr double kWeak = 50.0;  // second extent over the noise, chi-square
constexpr std::uint64_t kSeed = 20060;

// Geometry parameters of b less those of a.
Eigen::VectorXd difference(const Chain& a, const Chain& b) {
  Eigen::VectorXd out(a.geometry_parameters().size());
  for (std::size_t g = 0; g < a.geometry_parameters().size(); ++g) {
    const Chain::GeometryParameter& what = a.geometry_parameters()[g];
    out[g] = what.marker >= 0 ? b.marker(what.axis, what.marker) - a.marker(what.axis, what.marker)
                              : b.joint(what.axis, what.joint) - a.joint(what.axis, what.joint);
  }
  return out;
}

}  // namespace

double reach_of(const Chain& chain, int joint) {
  double reach = 0.0;
  for (const bool in_parent : {true, false}) {
    const Vector3d at = in_parent ? Vector3d(chain.joint.col(joint)) : Vector3d(Vector3d::Zero());
    double nearest = std::numeric_limits<double>::infinity();
    for (const int k : chain.layout.markers_of(in_parent ? chain.layout.parent[joint] : joint + 1))
      if (const double d = (chain.marker.col(k) - at).norm(); d < nearest) nearest = d;
    reach = std::max(reach, nearest);
  }
  return reach;
}

double distance_change(const Chain& chain, const ChainSamples& samples, const PosedFrames& frames,
                       int joint) {
  double worst = 0.0;
  for (const int s : {chain.layout.parent[joint], joint + 1})
    for (const int k : chain.layout.markers_of(s)) {
      double n = 0.0, mean = 0.0, squares = 0.0;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!samples.seen(frames.frame[i], k)) continue;
        const Eigen::Map<const Vector3d> x(samples.frame(frames.frame[i]) + 3 * k);
        const double d = (x - chain.joint_centre(frames.pose[i], joint)).norm();
        n += 1.0;
        const double off = d - mean;
        mean += off / n;
        squares += off * (d - mean);
      }
      if (n < 2.0) continue;
      const double change = std::sqrt(squares / n);
      worst = std::max(worst, std::isfinite(change) ? change : std::numeric_limits<double>::infinity());
    }
  return worst;
}

bool has_weak_rotation(const Chain& chain, double sigma_m) {
  for (int s = 0; s < chain.segments(); ++s) {
    if (chain.kind[s] == data::SegmentKind::line) continue;
    const std::vector<int> markers = chain.layout.markers_of(s);
    if (markers.size() < 3) continue;
    Vector3d mean = Vector3d::Zero();
    for (const int k : markers) mean += chain.marker.col(k) / static_cast<double>(markers.size());
    Matrix3d scatter = Matrix3d::Zero();
    for (const int k : markers)
      scatter += (chain.marker.col(k) - mean) * (chain.marker.col(k) - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(scatter, Eigen::EigenvaluesOnly);
    if (eigen.eigenvalues()[1] < kWeak * sigma_m * sigma_m) return true;
  }
  return false;
}

Bootstrap bootstrap(const ChainSamples& samples, const PosedFrames& frames, const FittedChain& fit,
                    int replicates) {
  const std::size_t n = std::min(frames.size(), kBootstrapFrames);
  const Chain& truth = fit.chain;
  Bootstrap out;
  out.bias = Eigen::VectorXd::Zero(truth.geometry_parameters().size());
  ChainSamples made;
  made.markers = samples.markers;
  made.frames = static_cast<std::int64_t>(n);
  made.x.resize(3 * n * static_cast<std::size_t>(samples.markers));
  std::vector<std::int64_t> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = static_cast<std::int64_t>(i);
  double chi2 = 0.0;
  double dof = 0.0;
  double squares = 0.0;
  double variance = 0.0;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    Random random(kSeed, static_cast<std::uint64_t>(replicate));
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t from = i * frames.size() / n;
      for (int k = 0; k < samples.markers; ++k) {
        double* x =
            made.x.data() + 3 * (i * static_cast<std::size_t>(samples.markers) + static_cast<std::size_t>(k));
        const double weight = fit.marker_weight[k];
        if (!samples.seen(frames.frame[from], k) || weight <= 0.0) {
          std::fill_n(x, 3, std::numeric_limits<double>::quiet_NaN());
          continue;
        }
        const Vector3d position = truth.predict(frames.pose[from], k);
        for (int axis = 0; axis < 3; ++axis) {
          x[axis] = position[axis] + fit.noise_sd_m / std::sqrt(weight) * random.gaussian();
        }
      }
    }
    Chain chain = truth;
    PosedFrames poses = first_poses(made, chain, all, fit.marker_weight, fit.noise_sd_m, 15);
    GeometryFit refit(chain, made, poses, fit.noise_sd_m);
    chi2 += refit.run(15) / (fit.noise_sd_m * fit.noise_sd_m);
    dof += refit.degrees_of_freedom();
    out.bias += difference(truth, chain) / replicates;
    if (replicate > 0) continue;
    ChainSolver solver(fit);
    ChainFrame frame;
    for (std::size_t i = 0; i < n; ++i) {
      solver.solve(made.frame(static_cast<std::int64_t>(i)), nullptr, frame);
      const ChainPose& pose = frames.pose[i * frames.size() / n];
      for (int j = 0; j < truth.joints(); ++j) {
        if (frame.state[j] != data::CentreState::determined) continue;
        squares += (frame.centre[j] - truth.joint_centre(pose, j)).squaredNorm();
        variance += frame.own_covariance[j].trace();
      }
    }
  }
  const Eigen::MatrixXd gauge = truth.gauge();
  out.bias -= (gauge * (gauge.transpose() * out.bias)).eval();
  if (dof > 0.0) out.chi2_ratio = chi2 / dof;
  if (variance > 0.0) out.variance_ratio = squares / variance;
  return out;
}

}  // namespace kinemark::skeleton::articulated

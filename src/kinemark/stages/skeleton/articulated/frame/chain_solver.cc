// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stages/skeleton/articulated/chain/robust_weights.h"
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::CentreState;
using data::SegmentKind;

// Minima nearer to the best than this many of its SD are part of it.
constexpr double kNear = 0.5;
// Several positions count as one when they at most double the variance that the best alone has. Three markers
// of a segment leave open only its rotation about their line, with no mirrored position: there its SD may be
// tripled.
constexpr double kCompact = 1.0;  // variance added over that of the best
constexpr double kCompactOfWhole = 8.0;
constexpr double kReach = 5.0;  // SD within which the joint lies, but for a probability that does not count
constexpr int kHalvings = 20;   // of the interval in which it is sought

}  // namespace

struct ChainSolver::Work {
  explicit Work(FittedChain fit_in)
      : fit(std::move(fit_in)), solver(fit.chain), finder(fit.chain), weights(fit.marker_weight) {
    lines = fit.chain.segments() == 2 && fit.chain.kind[0] == SegmentKind::line &&
            fit.chain.kind[1] == SegmentKind::line;
    for (const SegmentKind kind : fit.chain.kind) any_line = any_line || kind == SegmentKind::line;
    if (weights.empty()) weights.assign(fit.chain.markers(), 1.0);
  }

  FittedChain fit;
  PoseSolver solver;
  ModeFinder finder;
  FrameInformation information, observed;
  std::vector<double> weights, frame_weights;
  Eigen::MatrixXd H, H_observed, G;
  Eigen::VectorXd b;
  Eigen::Matrix3Xd by_frame, by_geometry, of_geometry;
  bool lines = false, any_line = false;

  void begin(const double* x, ChainFrame& out);
  void describe(const double* x, ChainFrame& out);
  void judge(ChainFrame& out);
  [[nodiscard]] double reach(const ChainFrame& frame, int joint, const Vector3d& mean) const;
  bool gather(ChainFrame& out, int joint, double most) const;
  bool follow_profile(ChainFrame& out, int joint);
  void reweigh(const double* x, ChainFrame& out);
};

void ChainSolver::Work::begin(const double* x, ChainFrame& out) {
  const int joints = fit.chain.joints();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  solver.set(x, weights);
  frame_weights = weights;
  out.seen = solver.sums().seen;
  out.mode_count = 0;
  out.gathered.assign(joints, Gathered::none);
  out.state.assign(joints, CentreState::undetermined);
  out.centre.assign(joints, Vector3d::Constant(nan));
  out.covariance.assign(joints, Matrix3d::Constant(nan));
  out.own_covariance.assign(joints, Matrix3d::Constant(nan));
  out.information.assign(joints, Matrix3d::Zero());
}

// Centres, covariances and information at the best mode.
void ChainSolver::Work::describe(const double* x, ChainFrame& out) {
  const Chain& chain = fit.chain;
  const ChainPose& pose = out.modes[0].pose;
  const double variance = fit.noise_sd_m * fit.noise_sd_m;
  solver.normal(pose, {}, false, H, b);
  information.set(chain, H);
  const FrameInformation* own = &information;
  if (any_line) {
    solver.normal(pose, {}, true, H_observed, b);
    observed.set(chain, H_observed);
    if (observed.rank() == information.rank()) own = &observed;
  }
  solver.linearize_geometry(pose, x, frame_weights, G, nullptr, nullptr);
  for (int j = 0; j < chain.joints(); ++j) {
    solver.joint_jacobian(pose, j, by_frame, by_geometry);
    out.centre[j] = chain.joint_centre(pose, j);
    const Eigen::Matrix3Xd gain = by_frame * own->inverse();
    out.own_covariance[j] = fit.covariance_scale * variance * gain * by_frame.transpose();
    of_geometry = by_geometry - gain * G;
    out.covariance[j] =
        out.own_covariance[j] + of_geometry * fit.geometry_covariance * of_geometry.transpose();
    out.information[j] = own->joint_information(by_frame) / (fit.covariance_scale * variance);
    out.state[j] = information.holds(by_frame) ? CentreState::determined : CentreState::undetermined;
  }
}

// The distance from `mean` beyond which the joint lies with a probability that does not count any more: each
// position has the spread of the best one.
double ChainSolver::Work::reach(const ChainFrame& frame, int joint, const Vector3d& mean) const {
  const auto beyond = [&](double limit) {
    double sum = 0.0;
    for (int i = 0; i < frame.mode_count; ++i) {
      const Vector3d d = frame.modes[i].centre[joint] - mean;
      const double far = d.norm();
      const double spread = std::sqrt(std::max(d.dot(frame.covariance[joint] * d), 0.0));  // times far
      if (spread > 0.0)
        sum += frame.modes[i].weight * 0.5 * std::erfc((limit - far) * far / (spread * std::numbers::sqrt2));
    }
    return sum;
  };
  double near = 0.0, far = kReach * std::sqrt(frame.covariance[joint].trace());
  for (int i = 0; i < frame.mode_count; ++i)
    far = std::max(far, (frame.modes[i].centre[joint] - mean).norm() +
                            kReach * std::sqrt(frame.covariance[joint].trace()));
  for (int step = 0; step < kHalvings; ++step) {
    const double middle = 0.5 * (near + far);
    (beyond(middle) < fit.alternative_max ? far : near) = middle;
  }
  return far;
}

// Several positions as one: their mean, with the variance of all, wide enough that kReach SD leave out none
// whose weight counts. False when that is more than `most` times what the best alone has.
bool ChainSolver::Work::gather(ChainFrame& out, int joint, double most) const {
  Vector3d mean = Vector3d::Zero();
  for (int i = 0; i < out.mode_count; ++i) mean += out.modes[i].weight * out.modes[i].centre[joint];
  Matrix3d between = Matrix3d::Zero();
  Vector3d farthest = Vector3d::Zero();
  for (int i = 0; i < out.mode_count; ++i) {
    const Vector3d d = out.modes[i].centre[joint] - mean;
    between += out.modes[i].weight * d * d.transpose();
    if (out.modes[i].weight >= fit.alternative_max && d.norm() > farthest.norm()) farthest = d;
  }
  const double own = out.covariance[joint].trace();
  const double short_of = std::pow(reach(out, joint, mean) / kReach, 2) - own - between.trace();
  if (short_of > 0.0 && farthest.norm() > 0.0)
    between += short_of * farthest.normalized() * farthest.normalized().transpose();
  if (between.trace() > most * own) return false;
  out.centre[joint] = mean;
  out.covariance[joint] += between;
  out.own_covariance[joint] += between;
  out.information[joint] = out.own_covariance[joint].inverse();
  out.gathered[joint] = Gathered::positions;
  return true;
}

// A curved valley or a fold that is no wider than about a Gaussian's: its mean and its variance. False when
// it is wider or goes on.
bool ChainSolver::Work::follow_profile(ChainFrame& out, int joint) {
  const auto moments = profile_moments(solver, out.modes[0].pose, out.modes[0].cost, joint,
                                       out.own_covariance[joint], fit.noise_sd_m);
  if (!moments || moments->variance_ratio > 1.0 + kCompact) return false;
  out.centre[joint] += moments->shift;
  out.covariance[joint] += moments->more;
  out.own_covariance[joint] += moments->more;
  out.information[joint] = out.own_covariance[joint].inverse();
  out.gathered[joint] = Gathered::valley;
  return true;
}

void ChainSolver::Work::judge(ChainFrame& out) {
  const Chain& chain = fit.chain;
  for (int j = 0; j < chain.joints(); ++j) {
    const int parent = chain.layout.parent[j];
    const int child = j + 1;
    const auto seen = [&](int s) { return solver.sums().segment[s].seen; };
    // A line that shows two markers has its joints on it, whatever the rest: no other minimum, no fold.
    const auto line_shows_two = [&](int s) { return chain.kind[s] == SegmentKind::line && seen(s) >= 2; };
    if (line_shows_two(parent) || line_shows_two(child)) continue;
    if (lines) out.state[j] = CentreState::undetermined;
    if (out.state[j] != CentreState::determined) continue;
    const double near = kNear * std::sqrt(out.covariance[j].trace());
    double elsewhere = 0.0;
    for (int i = 1; i < out.mode_count; ++i) {
      if ((out.modes[i].centre[j] - out.modes[0].centre[j]).norm() > near) elsewhere += out.modes[i].weight;
    }
    // Three markers in all put the joint on three spheres, which meet in two mirrored points, or in one where
    // these have just merged.
    const bool four = seen(parent) + seen(child) >= 4;
    const bool whole = std::max(seen(parent), seen(child)) >= 3;
    bool one_position = true;
    if (elsewhere >= fit.alternative_max)
      one_position = (four || whole) && gather(out, j, whole ? kCompactOfWhole : kCompact);
    else if (!whole && !profile_is_gaussian(solver, out.modes[0].pose, out.modes[0].cost, j,
                                            out.covariance[j], fit.noise_sd_m))
      one_position = four && follow_profile(out, j);
    if (!one_position) out.state[j] = CentreState::ambiguous;
  }
}

// Student's t: markers far from their position count less; modes are refined with the weights of the best
// one.
void ChainSolver::Work::reweigh(const double* x, ChainFrame& out) {
  for (int round = 0; round < 3; ++round) {
    if (!robust_weights(fit.chain, out.modes[0].pose, x, weights, fit.robust_dof, fit.noise_sd_m,
                        frame_weights))
      return;
    solver.set(x, frame_weights);
    for (int i = 0; i < out.mode_count; ++i) out.modes[i].cost = solver.refine(out.modes[i].pose);
  }
  for (int i = 0; i < out.mode_count; ++i) {
    for (int j = 0; j < fit.chain.joints(); ++j)
      out.modes[i].centre[j] = fit.chain.joint_centre(out.modes[i].pose, j);
  }
}

ChainSolver::ChainSolver(const FittedChain& fit) : work_(std::make_unique<Work>(fit)) {}
ChainSolver::~ChainSolver() = default;
ChainSolver::ChainSolver(ChainSolver&&) noexcept = default;
ChainSolver& ChainSolver::operator=(ChainSolver&&) noexcept = default;

void ChainSolver::solve(const double* x, const ChainPose* warm, ChainFrame& out) {
  Work& w = *work_;
  const Chain& chain = w.fit.chain;
  w.begin(x, out);
  if (out.seen == 0) return;
  bool settled = false;
  if (!w.lines && warm != nullptr && w.solver.shows_all_joints(w.fit.noise_sd_m)) {
    if (out.modes.empty()) out.modes.emplace_back();
    ChainMode& mode = out.modes[0];
    mode.pose.joint0 = warm->joint0;
    mode.pose.rotation = warm->rotation;
    mode.cost = w.solver.refine(mode.pose);
    const double dof = std::max(3.0 * out.seen - chain.frame_parameters(), 1.0);
    settled = mode.cost < w.fit.noise_sd_m * w.fit.noise_sd_m * (dof + 4.0 * std::sqrt(2.0 * dof)) ||
              w.finder.confirm(w.solver, w.fit.noise_sd_m, 40, mode.pose, mode.cost);
    if (settled) {
      mode.weight = 1.0;
      mode.centre.resize(chain.joints());
      for (int j = 0; j < chain.joints(); ++j) mode.centre[j] = chain.joint_centre(mode.pose, j);
      out.mode_count = 1;
    }
  }
  if (!settled) out.mode_count = w.finder.find(w.solver, x, w.fit.noise_sd_m, warm, 40, out.modes);
  if (w.fit.robust_dof > 0.0) w.reweigh(x, out);
  w.describe(x, out);
  w.judge(out);
}

double ChainSolver::solve_near(const double* x, const ChainPose& start, std::span<const JointPrior> priors,
                               ChainFrame& out) {
  Work& w = *work_;
  const Chain& chain = w.fit.chain;
  w.begin(x, out);
  if (out.modes.empty()) out.modes.emplace_back();
  ChainMode& mode = out.modes[0];
  mode.pose.joint0 = start.joint0;
  mode.pose.rotation = start.rotation;
  w.solver.refine(mode.pose, priors);
  mode.cost = w.solver.cost(mode.pose);
  mode.weight = 1.0;
  mode.centre.resize(chain.joints());
  for (int j = 0; j < chain.joints(); ++j) mode.centre[j] = chain.joint_centre(mode.pose, j);
  out.mode_count = 1;
  w.describe(x, out);
  std::fill(out.state.begin(), out.state.end(), CentreState::bridged);
  return mode.cost;
}

void ChainSolver::pose_from_centres(const double* x, std::span<const Vector3d> centres, ChainPose& out) {
  Work& w = *work_;
  check(static_cast<int>(centres.size()) == w.fit.chain.joints(), "one centre a joint");
  w.solver.set(x, w.weights);
  w.finder.starts().from_centres(w.solver, centres, out);
}

}  // namespace kinemark::skeleton::articulated

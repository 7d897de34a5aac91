// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/constant_distance.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/skeleton/functional/internal/complete_set.h"
#include "kinemark/stages/skeleton/functional/internal/lbfgs.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"

namespace kinemark::skeleton {
namespace {

/// The report's numbers are in millimetres; tolerances of the search are absolute, so it is done in them too.
constexpr double kPerMetre = 1e3;
constexpr int kRegressionSteps = 200;
/// Above this condition number the visible markers lie in a plane with the joint centre: its mirror image
/// fits equally well (mirror ambiguity).
constexpr double kFlat = 1e3;

/// Rounds in which markers that step (1) has not seen get their distances.
constexpr int kRounds = 3;
constexpr std::size_t kLeastKnown = 4;  ///< distances in a frame that another is measured in

/// The frames of step (1) and the markers that they show: all, or the largest set.
void choose_complete(const Samples& samples, const std::vector<int>& parent, const std::vector<int>& child,
                     int most, ConstantDistanceFit& fit) {
  auto frames = internal::frames_that_show(samples, fit.markers);
  fit.complete = fit.markers;
  const bool all = frames.size() >= 2;
  if (!all) {
    auto set = internal::find_complete_set(samples, parent, child);
    if (set.frames.empty()) {
      fit.complete_frames = std::ssize(frames);
      return;
    }
    fit.complete = std::move(set.markers);
    frames = std::move(set.frames);
  }
  fit.complete_frames = std::ssize(frames);
  const auto n = std::ssize(frames), used = std::min<std::ptrdiff_t>(n, most);
  for (std::ptrdiff_t i = 0; i < used; ++i) fit.chosen.push_back(frames[at(all ? i : i * n / used)]);
}

/// Step (1), in millimetres; `x` holds 3 K rows, one column a frame.
void place_in_chosen(const Eigen::MatrixXd& x, double penalty, ConstantDistanceFit& fit) {
  const Eigen::Index K = x.rows() / 3, F = x.cols();
  Eigen::VectorXd joints(3 * F);
  for (Eigen::Index f = 0; f < F; ++f) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < K; ++k) mean += x.block<3, 1>(3 * k, f);
    joints.segment<3>(3 * f) = mean / static_cast<double>(K);
  }
  Eigen::MatrixXd r(K, F);
  const auto measure = [&](const Eigen::VectorXd& at) {
    for (Eigen::Index f = 0; f < F; ++f)
      for (Eigen::Index k = 0; k < K; ++k) r(k, f) = (x.block<3, 1>(3 * k, f) - at.segment<3>(3 * f)).norm();
  };
  const auto n = static_cast<double>(F);
  const auto cost = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
    measure(at);
    gradient.setZero(at.size());
    double value = 0.0;
    for (Eigen::Index k = 0; k < K; ++k) {
      const double mean = r.row(k).mean();
      value += (r.row(k).array() - mean).square().sum() / n + penalty * mean;
      for (Eigen::Index f = 0; f < F; ++f) {
        if (r(k, f) == 0.0) continue;
        const double slope = (2.0 * (r(k, f) - mean) + penalty) / (n * r(k, f));
        gradient.segment<3>(3 * f) -= slope * (x.block<3, 1>(3 * k, f) - at.segment<3>(3 * f));
      }
    }
    return value;
  };
  internal::minimise_lbfgs(cost, joints);
  measure(joints);
  fit.distances_m = r.rowwise().mean() / kPerMetre;
  const double variance = (r.colwise() - r.rowwise().mean()).squaredNorm() / (n * static_cast<double>(K));
  fit.distance_sd_m = std::sqrt(variance) / kPerMetre;
  fit.centre_in_chosen = Eigen::Map<const Eigen::Matrix3Xd>(joints.data(), 3, F) / kPerMetre;
}

struct Seen {
  Eigen::Vector3d x;
  double distance;
};

/// Sum of squares of the distances' errors; normal matrix and right-hand side as well.
double linearize(const std::vector<Seen>& seen, const Eigen::Vector3d& at, Eigen::Matrix3d& normal,
                 Eigen::Vector3d& right) {
  normal.setZero();
  right.setZero();
  double cost = 0.0;
  for (const Seen& s : seen) {
    const Eigen::Vector3d d = at - s.x;
    const double r = d.norm(), error = r - s.distance;
    cost += error * error;
    if (r == 0.0) continue;
    const Eigen::Vector3d slope = d / r;
    normal += slope * slope.transpose();
    right -= error * slope;
  }
  return cost;
}

/// Step (2): Levenberg-Marquardt from the mean of the markers. Returns the normal matrix at the end.
Eigen::Matrix3d regress(const std::vector<Seen>& seen, Eigen::Vector3d& at) {
  at.setZero();
  for (const Seen& s : seen) at += s.x;
  at /= static_cast<double>(seen.size());
  Eigen::Matrix3d normal, next_normal;
  Eigen::Vector3d right, next_right;
  double cost = linearize(seen, at, normal, right), damping = 1e-3;
  for (int i = 0; i < kRegressionSteps && damping < 1e12; ++i) {
    Eigen::Matrix3d damped = normal;
    damped.diagonal() += damping * (normal.diagonal().array() + 1e-9).matrix();
    const Eigen::Vector3d step = damped.ldlt().solve(right), next = at + step;
    const double now = linearize(seen, next, next_normal, next_right);
    if (!(now <= cost)) {
      damping *= 4.0;
      continue;
    }
    const bool settled = cost - now <= 1e-12 * cost || step.norm() < 1e-12;
    at = next;
    normal = next_normal;
    right = next_right;
    cost = now;
    damping = std::max(1e-12, 0.2 * damping);
    if (settled) break;
  }
  return normal;
}

/// Step (1) of the markers that are complete; the others' distances are NaN.
void place_chosen(const Samples& samples, const ConstantDistanceOptions& options, ConstantDistanceFit& fit) {
  const auto K = fit.complete.size();
  Eigen::MatrixXd x(3 * static_cast<Eigen::Index>(K), static_cast<Eigen::Index>(fit.chosen.size()));
  for (std::size_t f = 0; f < fit.chosen.size(); ++f)
    for (std::size_t k = 0; k < K; ++k)
      x.block<3, 1>(3 * static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(f)) =
          kPerMetre * samples.x(fit.chosen[f], fit.complete[k]);
  place_in_chosen(x, kPerMetre * options.penalty_m, fit);
  const Eigen::VectorXd known = fit.distances_m;
  fit.distances_m = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(fit.markers.size()), kNaN);
  for (std::size_t k = 0; k < K; ++k)
    fit.distances_m(std::ranges::find(fit.markers, fit.complete[k]) - fit.markers.begin()) =
        known(static_cast<Eigen::Index>(k));
}

/// Step (2) in every frame, of the markers whose distances are known.
void regress_frames(const Samples& samples, std::size_t parents, ConstantDistanceFit& fit) {
  const auto frames = static_cast<std::size_t>(samples.trajectories.frames());
  fit.centre_in_world.assign(frames, Eigen::Vector3d::Constant(kNaN));
  fit.covariance.assign(frames, Eigen::Matrix3d::Constant(kNaN));
  fit.state.assign(frames, data::CentreState::undetermined);
  std::vector<Seen> seen;
  for (std::size_t f = 0; f < frames; ++f) {
    seen.clear();
    std::size_t on_parent = 0;
    for (std::size_t k = 0; k < fit.markers.size(); ++k) {
      const double distance = fit.distances_m(static_cast<Eigen::Index>(k));
      if (!std::isfinite(distance) || !samples.seen(static_cast<std::int64_t>(f), fit.markers[k])) continue;
      on_parent += k < parents;
      seen.push_back({samples.x(static_cast<std::int64_t>(f), fit.markers[k]), distance});
    }
    if (seen.size() < 3 || on_parent == 0 || on_parent == seen.size()) continue;
    const Eigen::Matrix3d normal = regress(seen, fit.centre_in_world[f]);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal);
    const bool unique = seen.size() > 3 && eigen.eigenvalues()(2) < kFlat * eigen.eigenvalues()(0);
    fit.state[f] = unique ? data::CentreState::determined : data::CentreState::ambiguous;
    const double variance = fit.distance_sd_m * fit.distance_sd_m;
    const Eigen::Vector3d values = eigen.eigenvalues().cwiseMax(0.0).array() +
                                   variance / (data::kJointPriorSd_m * data::kJointPriorSd_m) + 1e-15;
    fit.covariance[f] = variance * eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
                        eigen.eigenvectors().transpose();
  }
}

/// Distances of the markers that were not complete: medians over the frames that four known ones place.
void measure_others(const Samples& samples, ConstantDistanceFit& fit) {
  const Eigen::VectorXd before = fit.distances_m;
  for (std::size_t k = 0; k < fit.markers.size(); ++k) {
    if (std::ranges::find(fit.complete, fit.markers[k]) != fit.complete.end()) continue;
    std::vector<double> found;
    for (std::size_t f = 0; f < fit.state.size(); ++f) {
      const auto frame = static_cast<std::int64_t>(f);
      if (fit.state[f] != data::CentreState::determined || !samples.seen(frame, fit.markers[k])) continue;
      std::size_t known = 0;
      for (std::size_t i = 0; i < fit.markers.size(); ++i)
        known += i != k && std::isfinite(before(static_cast<Eigen::Index>(i))) &&
                 samples.seen(frame, fit.markers[i]);
      if (known >= kLeastKnown)
        found.push_back((samples.x(frame, fit.markers[k]) - fit.centre_in_world[f]).norm());
    }
    if (!found.empty()) fit.distances_m(static_cast<Eigen::Index>(k)) = math::median(found);
  }
}

}  // namespace

Status ConstantDistanceOptions::check() const {
  if (complete_frames < 2)
    return fail(Code::usage, fmt::format("{} complete frames; need 2 or more", complete_frames));
  if (!(penalty_m >= 0.0) || !std::isfinite(penalty_m))
    return fail(Code::usage, fmt::format("a distance penalty of {}; need 0 or more", penalty_m));
  return {};
}

Result<ConstantDistanceFit> fit_constant_distance(const Samples& samples, const std::vector<int>& parent,
                                                  const std::vector<int>& child,
                                                  const ConstantDistanceOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  ConstantDistanceFit fit;
  fit.markers = parent;
  fit.markers.insert(fit.markers.end(), child.begin(), child.end());
  choose_complete(samples, parent, child, options.complete_frames, fit);
  if (fit.chosen.size() < 2)
    return fail(Code::bad_input,
                fmt::format("{} all {} markers of its two segments, and no two show two markers of each; "
                            "constant-distance needs 2 or more, the other methods do not",
                            fit.complete_frames == 0 ? "no frames show" : "only one frame does show",
                            fit.markers.size()));
  place_chosen(samples, options, fit);
  for (int round = 0; round < kRounds && fit.complete.size() < fit.markers.size(); ++round) {
    regress_frames(samples, parent.size(), fit);
    measure_others(samples, fit);
  }
  regress_frames(samples, parent.size(), fit);
  return fit;
}

}  // namespace kinemark::skeleton

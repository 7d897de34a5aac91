// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/posture.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/math/statistics.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kStep_s = 0.02;
constexpr std::int64_t kMostFrames = 3000;
constexpr double kSmooth_s = 0.05;
constexpr double kDamped_rad = 4.0 * kRadPerDeg;  ///< a component of less SD is noise or crosstalk
/// Share of the posture's variance that smoothing and averaging may take away.
constexpr double kSmoothLoss = 0.02, kBlockLoss = 0.05;
constexpr double kBlock_s = 0.2;
constexpr double kLag_s = 0.1;
constexpr double kLeastStep = 0.5;  ///< a step of this many SDs from frame to frame is no path in time
constexpr double kMovementSmooth_s = 0.25, kLeastMovement_s = 0.8;
constexpr double kOneAxis = 0.25;  ///< of the second component's SD over the first's
constexpr double kSwing = 0.5;     ///< of the first component's SD: what is less is no movement

/// Means weighted by a normal density of `sigma` frames, the ends reflected.
Eigen::MatrixXd smoothed(const Eigen::MatrixXd& in, double sigma) {
  if (sigma < 0.3) return in;
  const auto n = in.rows();
  const auto reach = std::min<Eigen::Index>(static_cast<Eigen::Index>(std::ceil(4.0 * sigma)), n - 1);
  Eigen::VectorXd weight(2 * reach + 1);
  for (Eigen::Index k = -reach; k <= reach; ++k)
    weight(k + reach) = std::exp(-0.5 * std::pow(static_cast<double>(k) / sigma, 2));
  weight /= weight.sum();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, in.cols());
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = -reach; k <= reach; ++k) {
      Eigen::Index j = i + k;
      if (j < 0) j = -1 - j;
      if (j >= n) j = 2 * n - 1 - j;
      out.row(i) += weight(k + reach) * in.row(j);
    }
  return out;
}

/// Smoothing that takes nothing from the movement: halved until the rest is noise.
Eigen::MatrixX3d smooth_path(const Eigen::MatrixX3d& q, double step_s, bool& in_time) {
  const double all = q.squaredNorm();
  double sigma = kSmooth_s / step_s;
  Eigen::MatrixX3d out = smoothed(q, sigma);
  while (sigma >= 0.3 && (out - q).squaredNorm() > kSmoothLoss * all) {
    sigma *= 0.5;
    out = smoothed(q, sigma);
  }
  const auto n = q.rows();
  in_time = n > 2 && (q.bottomRows(n - 1) - q.topRows(n - 1)).squaredNorm() < kLeastStep * kLeastStep * all;
  return out;
}

/// Frames from one that can be used to the next, as a rule: 4 where a recorder made three of four.
std::int64_t spacing_of(const std::vector<std::int64_t>& frames) {
  if (frames.size() < 2) return 1;
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i)
    steps.push_back(static_cast<double>(frames[i] - frames[i - 1]));
  return std::max<std::int64_t>(1, std::llround(math::upper_median(steps)));
}

/// Frames of a block: 0.2 s, less where a mean over it would take from the movement.
Eigen::Index block_of(const Eigen::MatrixX3d& z, double step_s) {
  auto length = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::lround(kBlock_s / step_s)));
  for (; length > 1; length /= 2) {
    double lost = 0.0;
    const auto blocks = z.rows() / length;
    for (Eigen::Index b = 0; b < blocks; ++b) {
      const auto part = z.middleRows(b * length, length);
      lost += (part.rowwise() - part.colwise().mean()).squaredNorm();
    }
    if (blocks > 0 && lost <= kBlockLoss * z.squaredNorm()) return length;
  }
  return 1;
}

void fill_terms(Posture& posture, const Eigen::Vector3d& kept) {
  const auto n = posture.smooth.rows();
  const auto& z = posture.smooth;
  posture.terms = Eigen::MatrixXd::Zero(n, kPostureTerms);
  posture.terms.leftCols<kLinearTerms>() = z;
  int column = kLinearTerms;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++column) {
      posture.terms.col(column) = z.col(a).cwiseProduct(z.col(b));
      posture.terms.col(column).array() -= posture.terms.col(column).mean();
      posture.kind[at(column)] = TermKind::quadratic;
    }
  for (int k = 0; k < kLagTerms; ++k) posture.kind[at(column + k)] = TermKind::lag;
  for (int k = 0; k < kLinearTerms; ++k)
    posture.kind[at(k)] = kept(k) > 0.5 ? TermKind::linear : TermKind::damped;
  if (!posture.in_time || n < 3) return;
  const double scale = kLag_s / posture.step_s;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto from = std::max<Eigen::Index>(i - 1, 0), to = std::min<Eigen::Index>(i + 1, n - 1);
    posture.terms.row(i).rightCols<kLagTerms>() =
        (z.row(to) - z.row(from)) * (scale / static_cast<double>(to - from));
  }
}

/// A movement begins where the distance from the median posture, smoothed, rises through its mean: arcs of
/// many directions.
std::vector<int> rises_of_distance(const Posture& posture) {
  const auto n = posture.component.rows();
  std::vector<int> out(at(n), 0);
  Eigen::RowVector3d median;
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd column = posture.component.col(k);
    median(k) = math::median({column.data(), at(n)});
  }
  const Eigen::VectorXd far = (posture.component.rowwise() - median).rowwise().norm();
  const Eigen::VectorXd path = smoothed(far, kMovementSmooth_s / posture.step_s);
  const double mean = path.mean();
  Eigen::Index last = 0;
  int movement = 0;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    out[at(i)] = movement;
    if (!(path(i) < mean) || !(path(i + 1) >= mean)) continue;
    if (static_cast<double>(i - last) * posture.step_s <= kLeastMovement_s) continue;
    ++movement;
    last = i;
  }
  out.back() = movement;
  return out;
}

/// A movement begins where the first component, having been low, rises beyond half an SD: to and fro about
/// one axis. What lies before the first belongs to it.
std::vector<int> swings_of_first(const Posture& posture) {
  const auto n = posture.component.rows();
  std::vector<int> out(at(n), 0);
  const double bound = kSwing * posture.sd_rad(0);
  bool low = false;
  int begun = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (posture.component(i, 0) < -bound) low = true;
    if (low && posture.component(i, 0) > bound) {
      low = false;
      ++begun;
    }
    out[at(i)] = std::max(begun - 1, 0);
  }
  return out;
}

}  // namespace

Posture posture_of(const SegmentPoses& parent, const SegmentPoses& child, const RelativeMotion& motion,
                   const std::vector<std::int64_t>& frames, double rate_hz) {
  Posture out;
  const auto n = static_cast<std::int64_t>(frames.size());
  const double rate = rate_hz > 0.0 ? rate_hz / static_cast<double>(spacing_of(frames)) : 1.0 / kStep_s;
  const std::int64_t stride = std::max(
      {std::int64_t{1}, std::int64_t{std::lround(kStep_s * rate)}, (n + kMostFrames - 1) / kMostFrames});
  out.step_s = static_cast<double>(stride) / rate;
  for (std::int64_t i = 0; i < n; i += stride) out.frames.push_back(frames[at(i)]);
  const auto drawn = static_cast<Eigen::Index>(out.frames.size());
  out.component.resize(drawn, 3);
  for (Eigen::Index i = 0; i < drawn; ++i) {
    const auto f = at(out.frames[at(i)]);
    const Eigen::Matrix3d rotation = parent.world_from_segment[f].transpose() * child.world_from_segment[f];
    out.component.row(i) =
        (motion.axes.transpose() * math::log_so3(motion.mean.transpose() * rotation)).transpose();
  }
  if (drawn == 0) return out;
  out.component.rowwise() -= out.component.colwise().mean().eval();
  out.sd_rad = (out.component.colwise().squaredNorm() / static_cast<double>(drawn)).cwiseSqrt().transpose();
  Eigen::Vector3d kept;
  for (int k = 0; k < 3; ++k)
    kept(k) = 1.0 / (1.0 + std::pow(kDamped_rad / std::max(out.sd_rad(k), 1e-6), 4));
  out.smooth = smooth_path(out.component, out.step_s, out.in_time) * kept.asDiagonal();
  out.smooth.rowwise() -= out.smooth.colwise().mean().eval();
  out.block = block_of(out.smooth, out.step_s);
  fill_terms(out, kept);
  return out;
}

std::vector<int> movements_of(const Posture& posture) {
  const auto n = posture.component.rows();
  if (!posture.in_time || n < 3) return std::vector<int>(at(n), 0);
  auto swings = swings_of_first(posture);
  // To and fro about one axis the distance from the median rises twice in each movement.
  if (posture.sd_rad(1) < kOneAxis * posture.sd_rad(0)) return swings;
  auto far = rises_of_distance(posture);
  return far.back() >= swings.back() ? far : swings;
}

}  // namespace kinemark::skeleton::internal

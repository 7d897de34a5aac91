// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/slow_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kBlock_s = 0.2;            // three of them are about the smoother's time constant
constexpr std::int64_t kFramesOfBlock = 4;  // frames used of each block
constexpr double kBlind = 100.0;  // times the usual variance: the block is not determined by its markers

/// J'W S W J of one frame.
void spread_of(const model::Model& model, FrameRows& rows, const NoiseSplit& noise, MatrixXd& B) {
  auto& w = rows.workspace();
  const VectorXd& weight = rows.information().weight;
  const VectorXd spread = weight.cwiseAbs2().cwiseProduct(noise.slow);
  model::marker_normal_matrix(model, w, spread, B);
  MatrixXd segment;
  for (Index b = 0; b < noise.common_slow.size(); ++b) {
    if (noise.common_slow[b] == 0.0) continue;
    segment.setZero(3, model.speed_count());
    for (int m = 0; m < model.marker_count(); ++m) {
      if (model.markers()[at(m)].body != b || weight[m] == 0.0) continue;
      for (const int c : model.bodies()[at(b)].support) {
        const auto& s = w.column[at(c)];
        segment.col(model.columns()[at(c)].speed) +=
            weight[m] * (s.v + s.w.cross(Eigen::Vector3d(w.marker.col(m))));
      }
    }
    B.noalias() += noise.common_slow[b] * segment.transpose() * segment;
  }
}

/// Undetermined blocks take the value of the nearest determined ones.
void bridge(VectorXd& row) {
  Index last = -1;
  for (Index b = 0; b < row.size(); ++b) {
    if (std::isnan(row[b])) continue;
    for (Index gap = last + 1; gap < b; ++gap) row[gap] = last < 0 ? row[b] : std::max(row[last], row[b]);
    last = b;
  }
  for (Index gap = last + 1; gap < row.size(); ++gap) row[gap] = last < 0 ? 0.0 : row[last];
}

}  // namespace

SlowErrors::SlowErrors(const model::Model& model, const Observations& observations, const NoiseSplit& noise,
                       const std::vector<std::uint8_t>& fixed, const data::JointMotion& motion,
                       const MatrixXd& states) {
  const std::int64_t F = motion.frames();
  block_ = std::max<std::int64_t>(1, std::llround(kBlock_s * motion.time.rate_hz));
  const Index blocks = (F + block_ - 1) / block_, n = model.speed_count(), C = model.coordinate_count();
  variance_.setZero(C, blocks);
  if (!noise.any_slow) return;
  std::vector<MatrixXd> H(at(blocks), MatrixXd::Zero(n, n)), B = H;
  FrameRows rows(model);
  MatrixXd own;
  const std::int64_t stride = std::max<std::int64_t>(1, block_ / kFramesOfBlock);
  for (std::int64_t f = 0; f < F; f += stride) {
    (void)rows.visit(observations, f, states.col(f));
    rows.matrix(own);
    H[at(f / block_)] += own;
    spread_of(model, rows, noise, own);
    B[at(f / block_)] += own;
  }
  MatrixXd sum_H, sum_B, E;
  VectorXd q(C);
  model::Workspace w(model);
  for (Index b = 0; b < blocks; ++b) {
    sum_H.setZero(n, n);
    sum_B.setZero(n, n);
    for (Index k = std::max<Index>(0, b - 1); k <= std::min(blocks - 1, b + 1); ++k) {
      sum_H += H[at(k)];
      sum_B += B[at(k)];
    }
    sum_H.diagonal().array() += 1e-12 * sum_H.trace() + 1e-300;
    for (Index i = 0; i < n; ++i) {
      if (!fixed[at(i)]) continue;
      sum_H.row(i).setZero();
      sum_H.col(i).setZero();
      sum_H(i, i) = 1.0;
      sum_B.row(i).setZero();
      sum_B.col(i).setZero();
    }
    // Errors of neighbouring frames are fully correlated: sums of B grow with the square of the number of
    // frames used.
    const std::int64_t used =
        1 + (std::min((b + 2) * block_, F) - 1 - std::max<Index>(0, b - 1) * block_) / stride;
    const auto frames_used = static_cast<double>(used);
    const std::int64_t middle = std::min(F - 1, b * block_ + block_ / 2);
    std::copy_n(motion.q.data() + motion.index(middle, 0), C, q.data());
    model::kinematics(model, w, states.col(middle));
    model::coordinate_jacobian(model, w, q, E);
    const MatrixXd gain = sum_H.ldlt().solve(E.transpose());  // n x C
    for (Index c = 0; c < C; ++c)
      variance_(c, b) = std::max(0.0, frames_used * gain.col(c).dot(sum_B * gain.col(c)));
  }
  for (Index c = 0; c < C; ++c) {
    VectorXd row = variance_.row(c).transpose();
    const double usual = math::upper_median({row.data(), at(row.size())});
    for (double& v : row)
      if (!(v <= kBlind * usual)) v = std::numeric_limits<double>::quiet_NaN();
    bridge(row);
    variance_.row(c) = row.transpose();
  }
}

double SlowErrors::variance(std::int64_t f, int c) const { return variance_(c, f / block_); }

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/tissue.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::int64_t kTissueGrain = 64;
constexpr double kStill = 1e-3;        // rad or m, RMS: less is no motion
constexpr double kOwnDirection = 0.3;  // share of an angle that others do not explain, below it is left out
constexpr double kTissueChance = 1.5;  // energy that follows the posture over that of independent noise
constexpr double kLeastVisible =
    0.05;  // of the posture-bound energy, in residuals: below, nothing to divide by

/// State behind each speed that is a joint coordinate, -1 for those of free joints.
std::vector<int> states_of_speeds(const model::Model& model) {
  std::vector<int> state(at(model.speed_count()), -1);
  for (const auto& c : model.coordinates())
    if (c.speed_idx >= 0) state[at(c.speed_idx)] = c.state_idx;
  return state;
}

/// States of the joints next to every body, across welds.
std::vector<std::vector<int>> neighbours(const model::Model& model) {
  const auto state = states_of_speeds(model);
  const auto bodies = model.bodies();
  const auto own = [&](std::size_t b) {
    std::vector<int> found;
    for (int c = bodies[b].first_column; c < bodies[b].last_column; ++c)
      if (const int s = state[at(model.columns()[at(c)].speed)]; s >= 0) found.push_back(s);
    return found;
  };
  const auto welded = [&](std::size_t b) { return bodies[b].first_column == bodies[b].last_column; };
  std::vector<std::size_t> root(bodies.size());  // first body of a rigid cluster
  for (std::size_t b = 0; b < bodies.size(); ++b)
    root[b] = welded(b) && bodies[b].parent >= 0 ? root[at(bodies[b].parent)] : b;
  std::vector<std::vector<int>> of_cluster(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (root[b] != b) continue;
    const auto mine = own(b);
    of_cluster[b].insert(of_cluster[b].end(), mine.begin(), mine.end());
    if (bodies[b].parent < 0) continue;
    auto& parent = of_cluster[root[at(bodies[b].parent)]];
    parent.insert(parent.end(), mine.begin(), mine.end());
  }
  std::vector<std::vector<int>> near(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) near[b] = of_cluster[root[b]];
  return near;
}

}  // namespace

std::vector<MatrixXd> posture_fields(const Problem& problem, const MatrixXd& states) {
  const Index F = states.cols();
  std::vector<MatrixXd> fields;
  for (const auto& near : neighbours(problem.model)) {
    MatrixXd phi(F, static_cast<Index>(near.size()));
    Index used = 0;
    for (const int s : near) {
      VectorXd angle = states.row(s).transpose();
      angle.array() -= angle.mean();
      const double rms = std::sqrt(angle.squaredNorm() / static_cast<double>(F));
      if (rms < kStill) continue;
      angle /= rms;
      for (Index k = 0; k < used; ++k) angle -= phi.col(k) * (phi.col(k).dot(angle) / static_cast<double>(F));
      const double left = std::sqrt(angle.squaredNorm() / static_cast<double>(F));
      if (left < kOwnDirection) continue;
      phi.col(used++) = angle / left;
    }
    fields.emplace_back(phi.leftCols(used));
  }
  return fields;
}

TissuePass::TissuePass(const Problem& problem, const GeometryLayout& layout,
                       const data::Trajectories& markers, const MatrixXd& states, int threads)
    : problem_(problem),
      layout_(layout),
      markers_(markers),
      states_(states),
      threads_(threads),
      fields_(posture_fields(problem, states)),
      no_field_(states.cols(), 0),
      sums_(empty_sums()) {
  std::vector<Sums> partial(at((problem.frames + kTissueGrain - 1) / kTissueGrain));
  parallel_for(problem.frames, kTissueGrain, threads, [&](std::int64_t begin, std::int64_t end) {
    Sums& sums = partial[at(begin / kTissueGrain)];
    sums = empty_sums();
    FrameEquations frame(problem, layout);
    Eigen::Matrix3Xd y(3, problem.model.marker_count());
    VectorXd weight(problem.model.marker_count());
    for (std::int64_t f = begin; f < end; ++f) {
      problem.observe(markers, f, y, weight);
      if (weight.sum() == 0.0) continue;
      frame.visit(y, weight, states.col(f));
      add_frame(frame, f, sums);
    }
  });
  for (const auto& part : partial) {
    for (std::size_t m = 0; m < sums_.slide.size(); ++m) {
      sums_.slide[m] += part.slide[m];
      sums_.residual[m] += part.residual[m];
      sums_.field_visible[m] += part.field_visible[m];
    }
    sums_.squares += part.squares;
    sums_.seen += part.seen;
  }
}

const MatrixXd& TissuePass::field(Index marker) const {
  const int body = problem_.model.markers()[at(marker)].body;
  return body < 0 ? no_field_ : fields_[at(body)];
}

TissuePass::Sums TissuePass::empty_sums() const {
  const Index M = problem_.model.marker_count();
  Sums sums;
  for (Index m = 0; m < M; ++m) {
    const Index K = field(m).cols();
    sums.slide.emplace_back(MatrixXd::Zero(layout_.columns, 3 * K));
    sums.residual.emplace_back(MatrixXd::Zero(3, K));
    sums.field_visible.emplace_back(VectorXd::Zero(K));
  }
  sums.squares.setZero(M);
  sums.seen.setZero(M);
  return sums;
}

namespace {

/// G_i = Jp_i' w - LinvW' L^-1 J_i' w, parameters x 3, and tr P_ii.
double geometry_response(const FrameEquations& frame, Index m, MatrixXd& G, MatrixXd& half) {
  half = frame.J.middleRows<3>(3 * m).transpose();
  frame.llt.matrixL().solveInPlace(half);
  G.noalias() = -frame.weight[m] * (frame.LinvW.transpose() * half);
  for (const auto& [column, d] : frame.derivative[at(m)]) G.row(column) += frame.weight[m] * d.transpose();
  return std::max(0.0, 3.0 - frame.weight[m] * half.squaredNorm());
}

}  // namespace

void TissuePass::add_frame(const FrameEquations& frame, std::int64_t f, Sums& sums) const {
  MatrixXd G(layout_.columns, 3), half, rotated;
  for (Index m = 0; m < frame.weight.size(); ++m) {
    const int body = problem_.model.markers()[at(m)].body;
    if (frame.weight[m] == 0.0 || body < 0) continue;
    const Vector3d r = frame.residual.col(m);
    sums.squares[m] += r.squaredNorm();
    sums.seen[m] += 1.0;
    const MatrixXd& phi = fields_[at(body)];
    if (phi.cols() == 0) continue;
    const double visible = geometry_response(frame, m, G, half);
    const Eigen::Matrix3d& R = frame.w.rotation[at(body)];
    rotated.noalias() = G * R;
    const Vector3d r_in_body = R.transpose() * r;
    for (Index k = 0; k < phi.cols(); ++k) {
      sums.slide[at(m)].middleCols(3 * k, 3) += phi(f, k) * rotated;
      sums.residual[at(m)].col(k) += phi(f, k) * r_in_body;
      sums.field_visible[at(m)][k] += phi(f, k) * phi(f, k) * visible;
    }
  }
}

TissueModel TissuePass::detect(const MarkerVariances& variances) const {
  const Index M = problem_.model.marker_count();
  TissueModel tissue;
  tissue.own_slow.setZero(M);
  tissue.own_fast = variances.own;
  tissue.common_slow.setZero(variances.common.size());
  tissue.common_fast = variances.common;
  double bound = 0.0, chance = 0.0;
  VectorXd share = VectorXd::Zero(M), fields = VectorXd::Zero(M);
  for (Index m = 0; m < M; ++m) {
    const auto K = static_cast<double>(field(m).cols()), seen = sums_.seen[m];
    if (K == 0.0 || seen < 2.0 * K + 4.0 || sums_.squares[m] == 0.0) continue;
    const double energy = sums_.residual[at(m)].squaredNorm() / seen;
    const double expected = K * std::max(0.0, sums_.squares[m] - energy) / (seen - K);
    bound += energy;
    chance += expected;
    fields[m] = K;
    share[m] = std::clamp((energy - expected) / sums_.squares[m], 0.0, 1.0);
  }
  tissue.found = bound > kTissueChance * chance && bound > 0.0;
  if (!tissue.found) return tissue;

  double slow = 0.0, all = 0.0, inflation = 0.0;
  VectorXd of_body = VectorXd::Zero(variances.common.size()), on_body = of_body;
  for (Index m = 0; m < M; ++m) {
    const int body = problem_.model.markers()[at(m)].body;
    tissue.own_slow[m] = share[m] * variances.own[m];
    tissue.own_fast[m] = variances.own[m] - tissue.own_slow[m];
    if (body < 0) continue;
    of_body[body] += share[m];
    on_body[body] += 1.0;
    slow += share[m] * (variances.own[m] + variances.common[body]);
    all += variances.own[m] + variances.common[body];
    if (fields[m] > 0.0)
      inflation += share[m] * (variances.own[m] + variances.common[body]) * (sums_.seen[m] - 1.0) / fields[m];
  }
  for (Index b = 0; b < of_body.size(); ++b) {
    if (on_body[b] == 0.0) continue;
    tissue.common_slow[b] = of_body[b] / on_body[b] * variances.common[b];
    tissue.common_fast[b] = variances.common[b] - tissue.common_slow[b];
  }
  tissue.sd_m = std::sqrt(slow / static_cast<double>(M));
  tissue.inflation = all > 0.0 ? 1.0 + inflation / all : 1.0;
  return tissue;
}

MatrixXd TissuePass::independent_part(const VectorXd& own, const VectorXd& common) const {
  const Index P = layout_.columns;
  std::vector<MatrixXd> partial(at((problem_.frames + kTissueGrain - 1) / kTissueGrain));
  parallel_for(problem_.frames, kTissueGrain, threads_, [&](std::int64_t begin, std::int64_t end) {
    MatrixXd& B = partial[at(begin / kTissueGrain)];
    B.setZero(P, P);
    FrameEquations frame(problem_, layout_);
    Eigen::Matrix3Xd y(3, problem_.model.marker_count());
    VectorXd weight(problem_.model.marker_count());
    MatrixXd G(P, 3), half, rows(P, 3 * (own.size() + common.size()));
    for (std::int64_t f = begin; f < end; ++f) {
      problem_.observe(markers_, f, y, weight);
      if (weight.sum() == 0.0) continue;
      frame.visit(y, weight, states_.col(f));
      rows.setZero();
      for (Index m = 0; m < own.size(); ++m) {
        if (weight[m] == 0.0) continue;
        geometry_response(frame, m, G, half);
        rows.middleCols(3 * m, 3) = std::sqrt(own[m]) * G;
        if (const int body = problem_.model.markers()[at(m)].body; body >= 0)
          rows.middleCols(3 * (own.size() + body), 3) += std::sqrt(common[body]) * G;
      }
      B.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    }
  });
  MatrixXd sum = MatrixXd::Zero(P, P);
  for (const auto& part : partial) sum += part;
  return sum.selfadjointView<Eigen::Lower>();
}

MatrixXd TissuePass::middle(const TissueModel& tissue, const MatrixXd& inverse_S) const {
  MatrixXd B = independent_part(tissue.own_fast, tissue.common_fast);
  std::vector<MatrixXd> of_body(problem_.model.bodies().size());
  for (Index m = 0; m < tissue.own_slow.size(); ++m) {
    const MatrixXd& slide = sums_.slide[at(m)];
    const Index K = field(m).cols();
    if (K == 0) continue;
    const int body = problem_.model.markers()[at(m)].body;
    if (of_body[at(body)].size() == 0) of_body[at(body)].setZero(slide.rows(), slide.cols());
    of_body[at(body)] += slide;
    // The fitted geometry absorbs part of such a displacement, which is then missing from the residuals.
    const double visible = sums_.field_visible[at(m)].sum();
    const double hidden = (inverse_S * slide).cwiseProduct(slide).sum();
    const double left = visible > 0.0 ? std::clamp(1.0 - hidden / visible, kLeastVisible, 1.0) : 1.0;
    B.noalias() += tissue.own_slow[m] / (left * static_cast<double>(K)) * slide * slide.transpose();
  }
  for (std::size_t b = 0; b < of_body.size(); ++b) {
    const double variance = tissue.common_slow[static_cast<Index>(b)];
    const Index K = fields_[b].cols();
    if (variance > 0.0 && K > 0)
      B.noalias() += variance / static_cast<double>(K) * of_body[b] * of_body[b].transpose();
  }
  return B;
}

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/motion_output.h"

#include <algorithm>
#include <array>

#include "kinemark/core/index.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Speeds and accelerations of the tree in frame f by five-point differences of the states.
void speeds_of_states(const model::Model& model, const MatrixXd& states, std::int64_t f, double rate_hz,
                      VectorXd& v, VectorXd& vdot) {
  // Differences to the neighbouring frames; beyond the ends a parabola through the last three frames.
  const Index F = states.cols();
  std::array<VectorXd, 5> way;  // frames f - 2 to f + 2
  const auto exists = [&](Index k) { return k >= 0 && k < F; };
  for (Index j = -2; j <= 2; ++j) {
    auto& here = way[at(j + 2)];
    here.setZero(model.speed_count());
    if (j != 0 && exists(f + j)) model::difference(model, states.col(f), states.col(f + j), here);
  }
  for (const Index side : {-1, 1}) {
    VectorXd inner;
    if (!exists(f - side) || !exists(f - 2 * side)) continue;
    if (!exists(f + side)) {  // this is the end: frames f, f - side, f - 2 side are known
      way[at(2 + side)] = -3.0 * way[at(2 - side)] + way[at(2 - 2 * side)];
      way[at(2 + 2 * side)] = -8.0 * way[at(2 - side)] + 3.0 * way[at(2 - 2 * side)];
    } else if (!exists(f + 2 * side)) {  // one before the end: f + side, f, f - side
      way[at(2 + 2 * side)] = 3.0 * way[at(2 + side)] + way[at(2 - side)];
    }
  }
  v = rate_hz * (8.0 * (way[3] - way[1]) - (way[4] - way[0])) / 12.0;
  vdot = rate_hz * rate_hz * (16.0 * (way[3] + way[1]) - (way[4] + way[0])) / 12.0;
}

}  // namespace

void fill_coordinates(const model::Model& model, const MatrixXd& states, data::JointMotion& motion) {
  const int n = model.coordinate_count();
  const std::int64_t F = motion.frames();
  VectorXd near(n), q(n), v, vdot, qd, qdd;
  for (int c = 0; c < n; ++c) near[c] = model.description().coordinates[at(c)].default_value;
  for (auto* out : {&motion.q, &motion.qd, &motion.qdd}) out->resize(at(F * n));
  model::Workspace w(model);
  for (std::int64_t f = 0; f < F; ++f) {
    model::coordinates_from_state(model, states.col(f), near, q);
    near = q;
    speeds_of_states(model, states, f, motion.time.rate_hz, v, vdot);
    model::kinematics(model, w, states.col(f));
    model::rates_from_speeds(model, w, q, v, vdot, qd, qdd);
    std::copy_n(q.data(), n, motion.q.data() + motion.index(f, 0));
    std::copy_n(qd.data(), n, motion.qd.data() + motion.index(f, 0));
    std::copy_n(qdd.data(), n, motion.qdd.data() + motion.index(f, 0));
  }
}

void coordinate_covariances(const MatrixXd& joint, int index, double rate_hz, const MatrixXd& E,
                            MatrixXd& out) {
  const Index n = E.cols();
  const double r = rate_hz;
  Eigen::Matrix3d T = Eigen::Matrix3d::Zero(), window;
  T(0, index) = 1.0;
  if (index == 0)
    T.row(1) << -1.5 * r, 2.0 * r, -0.5 * r;
  else if (index == 1)
    T.row(1) << -0.5 * r, 0.0, 0.5 * r;
  else
    T.row(1) << 0.5 * r, -2.0 * r, 1.5 * r;
  T.row(2) << r * r, -2.0 * r * r, r * r;
  out.resize(6, E.rows());
  std::vector<Index> moved_by;
  for (Index c = 0; c < E.rows(); ++c) {
    moved_by.clear();
    for (Index i = 0; i < n; ++i)
      if (E(c, i) != 0.0) moved_by.push_back(i);
    window.setZero();
    for (Index a = 0; a < 3; ++a)
      for (Index b = 0; b < 3; ++b)
        for (const Index i : moved_by)
          for (const Index j : moved_by) window(a, b) += E(c, i) * E(c, j) * joint(a * n + i, b * n + j);
    const Eigen::Matrix3d C = T * window * T.transpose();
    math::pack_symmetric3(C, out.col(c).data());
  }
}

}  // namespace kinemark::motion::internal

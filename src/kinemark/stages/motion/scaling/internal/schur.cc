// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/schur.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Moves = GeometryTerm::Moves;

constexpr double kFloor = 1e-10;  // of the total weight: holds undetermined directions of a posture

bool hangs_on(const model::Model& model, int body, int ancestor) {
  while (body > ancestor) body = model.bodies()[at(body)].parent;
  return body == ancestor;
}

}  // namespace

GeometryLayout::GeometryLayout(const Problem& problem, const data::ModelDescription& full,
                               std::span<const GeometryParameter> parameters)
    : of_marker(at(problem.model.marker_count())), columns(static_cast<int>(parameters.size())) {
  const auto& model = problem.model;
  for (int k = 0; k < columns; ++k)
    for (const auto& given : parameters[at(k)].terms) {
      Term term{.moves = given.moves, .column = k, .direction = given.direction};
      if (given.moves == Moves::marker) {
        const int m = model.description().find_marker(full.markers[at(given.idx)].name);
        if (m < 0) continue;  // never seen: only its prior determines it
        term.body = model.markers()[at(m)].body;
        of_marker[at(m)].push_back(static_cast<int>(terms.size()));
        terms.push_back(term);
        continue;
      }
      const auto& joint = full.joints[at(given.idx)];
      const int child = model.body_of(joint.child_body_idx);
      term.body = given.moves == Moves::parent_frame ? model.bodies()[at(child)].parent : child;
      if (given.moves == Moves::translation) {
        term.axis = joint.axes[at(given.axis)];
        term.direction = given.rate * term.axis.axis.normalized();
      }
      for (int m = 0; m < model.marker_count(); ++m)
        if (hangs_on(model, model.markers()[at(m)].body, child))
          of_marker[at(m)].push_back(static_cast<int>(terms.size()));
      terms.push_back(term);
    }
}

Vector3d GeometryLayout::velocity(const Term& term, const model::Workspace& w) {
  if (term.moves == Moves::translation) {
    const auto value = [&](int coordinate, const math::ScalarFunction& f) {
      return f(coordinate < 0 ? 0.0 : w.q[coordinate]).f;
    };
    double v = value(term.axis.coordinate_idx, term.axis.function);
    if (term.axis.second_coordinate_idx >= 0)
      v *= value(term.axis.second_coordinate_idx, term.axis.second_function);
    return v * (w.joint_rotation[at(term.body)] * term.direction);
  }
  if (term.body < 0) return term.direction;  // on the ground
  const Vector3d d = w.rotation[at(term.body)] * term.direction;
  return term.moves == Moves::child_frame ? Vector3d(-d) : d;
}

NormalSums& NormalSums::operator+=(const NormalSums& other) {
  S += other.S;
  g += other.g;
  weighted_squares += other.weighted_squares;
  squares += other.squares;
  seen += other.seen;
  return *this;
}

FrameEquations::FrameEquations(const Problem& problem, const GeometryLayout& layout)
    : w(problem.model),
      derivative(at(problem.model.marker_count())),
      residual(Eigen::Matrix3Xd::Zero(3, problem.model.marker_count())),
      problem_(problem),
      layout_(layout),
      velocity_(layout.terms.size()),
      q_(VectorXd::Zero(problem.model.coordinate_count())) {}

void FrameEquations::add_tasks(double total, const VectorXd& x) {
  if (problem_.coordinate_tasks.empty()) return;
  model::coordinates_from_state(problem_.model, x, q_, q_);
  model::coordinate_jacobian(problem_.model, w, q_, E_);
  for (const auto& task : problem_.coordinate_tasks)
    H_.noalias() += total * task.weight * E_.row(task.coordinate).transpose() * E_.row(task.coordinate);
}

void FrameEquations::visit(const Eigen::Matrix3Xd& y, const VectorXd& given_weight, const VectorXd& x) {
  const auto& model = problem_.model;
  weight = given_weight;
  model::kinematics(model, w, x);
  model::marker_jacobian(model, w, J);
  const double total = weight.sum();
  model::marker_normal_matrix(model, w, weight, H_);
  add_tasks(total, x);
  H_.diagonal().array() += kFloor * total;
  hold_speeds(H_, problem_.fixed_speed);
  for (Eigen::Index i = 0; i < J.cols(); ++i)
    if (problem_.fixed_speed[at(i)] != 0) J.col(i).setZero();
  llt.compute(H_);

  for (std::size_t t = 0; t < velocity_.size(); ++t)
    velocity_[t] = GeometryLayout::velocity(layout_.terms[t], w);
  LinvW.setZero(model.speed_count(), layout_.columns);
  for (int m = 0; m < model.marker_count(); ++m) {
    auto& columns = derivative[at(m)];
    columns.clear();
    residual.col(m).setZero();
    if (weight[m] == 0.0) continue;
    residual.col(m) = y.col(m) - w.marker.col(m);
    for (const int t : layout_.of_marker[at(m)]) {
      const int column = layout_.terms[at(t)].column;
      if (columns.empty() || columns.back().column != column) columns.push_back({.column = column});
      columns.back().d += velocity_[at(t)];
    }
    const auto rows = J.middleRows<3>(3 * m);
    for (const auto& [column, d] : columns) LinvW.col(column).noalias() += rows.transpose() * (weight[m] * d);
  }
  llt.matrixL().solveInPlace(LinvW);
}

// The gradient is that of the geometry alone: at the best posture the other part vanishes.
void FrameEquations::add_to(NormalSums& sums) const {
  for (Eigen::Index m = 0; m < weight.size(); ++m) {
    if (weight[m] == 0.0) continue;
    const Vector3d r = residual.col(m);
    sums.weighted_squares += weight[m] * r.squaredNorm();
    sums.squares += r.squaredNorm();
    ++sums.seen;
    const auto& columns = derivative[at(m)];
    for (std::size_t a = 0; a < columns.size(); ++a) {
      const Vector3d d = weight[m] * columns[a].d;
      sums.g[columns[a].column] += d.dot(r);
      for (std::size_t b = 0; b <= a; ++b)
        sums.S(columns[a].column, columns[b].column) += d.dot(columns[b].d);
    }
  }
  sums.S.selfadjointView<Eigen::Lower>().rankUpdate(LinvW.transpose(), -1.0);
}

VectorXd FrameEquations::posture_gradient() const {
  VectorXd gradient = VectorXd::Zero(J.cols());
  for (Eigen::Index m = 0; m < weight.size(); ++m)
    if (weight[m] != 0.0)
      gradient.noalias() += J.middleRows<3>(3 * m).transpose() * (weight[m] * residual.col(m));
  return gradient;
}

void FrameEquations::add_posture_part(const VectorXd& gradient, NormalSums& sums) const {
  sums.g.noalias() -= LinvW.transpose() * llt.matrixL().solve(gradient);
}

}  // namespace kinemark::motion::internal

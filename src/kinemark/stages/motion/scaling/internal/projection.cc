// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/projection.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/motion/internal/frame_solver.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kGrain = 32;
constexpr double kClearlyBetter = 0.98;  // largest cost ratio at which another posture is accepted

/// The same parameters for a description that holds some of the markers only.
std::vector<GeometryParameter> rename_markers(const data::ModelDescription& full,
                                              const data::ModelDescription& base,
                                              std::vector<GeometryParameter> parameters) {
  for (auto& parameter : parameters) {
    for (auto& term : parameter.terms)
      if (term.moves == GeometryTerm::Moves::marker)
        term.idx = base.find_marker(full.markers[at(term.idx)].name);
    std::erase_if(parameter.terms, [](const GeometryTerm& term) { return term.idx < 0; });
  }
  return parameters;
}

}  // namespace

Projection::Projection(const data::ModelDescription& full, const std::vector<GeometryParameter>& parameters,
                       Problem problem, IkOptions options, const data::Trajectories& markers, int threads)
    : problem_(std::move(problem)),
      layout_(problem_, full, parameters),
      base_(problem_.model.description()),
      parameters_(rename_markers(full, base_, parameters)),
      options_(std::move(options)),
      markers_(markers),
      threads_(threads) {}

ProjectedSums Projection::solve(const Eigen::VectorXd& x, Eigen::MatrixXd& states) {
  auto compiled = x.allFinite() ? model::Model::compile(apply_geometry(base_, parameters_, x),
                                                        {.free_roots = !problem_.model.free_joints().empty()})
                                : fail(Code::bad_input, "sizes that are not finite");
  if (!compiled) {
    ProjectedSums none(layout_.columns);
    none.cost = std::numeric_limits<double>::quiet_NaN();
    return none;
  }
  problem_.model = std::move(*compiled);
  const std::int64_t visited = (problem_.frames + stride_ - 1) / stride_;
  std::vector<ProjectedSums> partial(at((visited + kGrain - 1) / kGrain), ProjectedSums(layout_.columns));
  parallel_for(visited, kGrain, threads_, [&](std::int64_t begin, std::int64_t end) {
    ProjectedSums& sums = partial[at(begin / kGrain)];
    FrameSolver solver(problem_, options_);
    FrameEquations equations(problem_, layout_);
    Eigen::Matrix3Xd y(3, problem_.model.marker_count());
    Eigen::VectorXd weight(problem_.model.marker_count()), state;
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t f = i * stride_;
      problem_.observe(markers_, f, y, weight);
      const auto visible = (weight.array() > 0.0).count();
      if (visible == 0) continue;
      state = states.col(f);
      sums.cost += solver.solve(y, weight, f, state).cost * weight.sum();
      states.col(f) = state;
      equations.visit(y, weight, state);
      equations.add_to(sums.normal);
      const auto free_speeds = std::count(problem_.fixed_speed.begin(), problem_.fixed_speed.end(), 0);
      sums.moved_speeds += std::min<std::int64_t>(free_speeds, 3 * visible);
    }
  });
  ProjectedSums total(layout_.columns);
  for (const auto& part : partial) {
    total.normal += part.normal;
    total.cost += part.cost;
    total.moved_speeds += part.moved_speeds;
  }
  return total;
}

NormalSums Projection::sums_at(const Eigen::MatrixXd& best, const Eigen::MatrixXd& quiet) const {
  std::vector<NormalSums> partial(at((problem_.frames + kGrain - 1) / kGrain), NormalSums(layout_.columns));
  parallel_for(problem_.frames, kGrain, threads_, [&](std::int64_t begin, std::int64_t end) {
    FrameEquations equations(problem_, layout_);
    Eigen::Matrix3Xd y(3, problem_.model.marker_count());
    Eigen::VectorXd weight(problem_.model.marker_count());
    for (std::int64_t f = begin; f < end; ++f) {
      problem_.observe(markers_, f, y, weight);
      if (weight.sum() == 0.0) continue;
      equations.visit(y, weight, best.col(f));
      const Eigen::Matrix3Xd residual = equations.residual;
      const Eigen::VectorXd balance = equations.posture_gradient();
      equations.visit(y, weight, quiet.col(f));
      equations.residual = residual;
      equations.add_to(partial[at(begin / kGrain)]);
      equations.add_posture_part(equations.posture_gradient() - balance, partial[at(begin / kGrain)]);
    }
  });
  NormalSums total(layout_.columns);
  for (const auto& part : partial) total += part;
  return total;
}

std::int64_t Projection::free_caught_frames(Eigen::MatrixXd& states) const {
  FrameSolver solver(problem_, options_);
  Eigen::Matrix3Xd y(3, problem_.model.marker_count());
  Eigen::VectorXd weight(problem_.model.marker_count()), state;
  std::vector<double> cost(at(problem_.frames), -1.0);
  std::vector<bool> freed(at(problem_.frames), false);
  const auto visit = [&](std::int64_t f, std::int64_t neighbour) {
    problem_.observe(markers_, f, y, weight);
    if (weight.sum() == 0.0) return;
    if (cost[at(f)] < 0.0) {
      state = states.col(f);
      cost[at(f)] = solver.solve(y, weight, f, state).cost;
      states.col(f) = state;
    }
    if (neighbour < 0 || neighbour >= problem_.frames) return;
    state = states.col(neighbour);
    const double other = solver.solve(y, weight, f, state).cost;
    if (!(other < kClearlyBetter * cost[at(f)])) return;
    cost[at(f)] = other;
    states.col(f) = state;
    freed[at(f)] = true;
  };
  for (std::int64_t f = 0; f < problem_.frames; ++f) visit(f, f - 1);
  for (std::int64_t f = problem_.frames - 1; f >= 0; --f) visit(f, f + 1);
  return std::count(freed.begin(), freed.end(), true);
}

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

#include <utility>

#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::motion::testing_leg {

Solved solve(const data::ModelDescription& model, const data::Trajectories& markers) {
  IkOptions options;
  options.limits = false;
  options.error_bars = false;
  const auto compiled = model::Model::compile(model).value();
  const auto solution = solve_ik(compiled, markers, options).value();
  auto problem = internal::make_problem(compiled, markers, options).value();
  Eigen::MatrixXd states(compiled.state_count(), markers.frames());
  const auto n = static_cast<std::int64_t>(compiled.coordinate_count());
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    states.col(f) = model::state_from_coordinates(
        problem.model, Eigen::Map<const Eigen::VectorXd>(solution.motion.q.data() + f * n, n));
  return {.options = options, .problem = std::move(problem), .states = std::move(states)};
}

std::vector<GeometryParameter> sizes_and_positions(const data::ModelDescription& model,
                                                   const std::vector<std::string>& markers) {
  auto list = scale_parameters(model, default_scale_groups(model)).value();
  if (markers.empty()) return list;
  const auto positions = marker_parameters(model, markers).value();
  list.insert(list.end(), positions.begin(), positions.end());
  return list;
}

}  // namespace kinemark::motion::testing_leg

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tasks that levels name: checked against model and options, and made.
#pragma once

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "kinemark/stages/motion/control/internal/plan.h"

namespace kinemark::motion::internal {

/// Names of the model's markers that named tasks are made of.
///
/// Errors, one sentence each: bodies, coordinates, markers and axes that are not there (with the nearest
/// name), what is asked for twice, units that a coordinate does not have, values beyond its range,
/// coordinates that are locked as well.
[[nodiscard]] Result<std::set<std::string>> markers_of_tasks(const model::Model& model,
                                                             const TrackOptions& options);

/// Make the tasks that the level `asked` names, for the model and the marker weights of the plan. `rest`:
/// coordinates of the rest pose.
void place_named(const TrackLevel& asked, const Eigen::VectorXd& rest, Plan& plan, Plan::Level& level);

/// "; did you mean 'A' or 'B'?", or nothing.
[[nodiscard]] std::string nearest_of(const std::string& name, const std::vector<std::string>& names);

}  // namespace kinemark::motion::internal

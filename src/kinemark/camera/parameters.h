// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Names of a camera's parameters in the order of data::ParameterLayout: "rotation_x", "focal", "warp_x_2_1"
/// (the factor of x^2 y in the warp of x), "crosstalk_0_3", ...
[[nodiscard]] std::vector<std::string> parameter_names(const data::Camera& camera);

/// The camera with every parameter moved by step (layout of data::ParameterLayout).
[[nodiscard]] data::Camera moved(const data::Camera& camera, const Eigen::Ref<const Eigen::VectorXd>& step);

/// The step with moved(from, step) = to. Both cameras have the same layout.
[[nodiscard]] Eigen::VectorXd step_between(const data::Camera& from, const data::Camera& to);

/// The same camera with a warp of another degree, terms of the old one kept, new ones 0, higher ones dropped.
[[nodiscard]] data::Camera with_warp_degree(const data::Camera& camera, int degree);

}  // namespace kinemark::camera

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The smallest limb for the tests of this folder: an upper arm and a forearm on two hinges about z.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/model_description.h"

namespace kinemark::motion::testing_body {

/// Coordinates shoulder and elbow, -2.8 to 2.8 rad; bodies upper (0) and fore (1).
/// @param elbow  in the upper arm, m
[[nodiscard]] data::ModelDescription planar_arm(const Eigen::Vector3d& elbow,
                                                std::vector<data::MarkerDescription> markers);

}  // namespace kinemark::motion::testing_body

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Seeded trees that contain every feature a model file can have, for tests.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kinemark/core/random.h"
#include "kinemark/data/model_description.h"
#include "kinemark/model/model.h"

namespace kinemark::model::testing {

/// Ten bodies, listed children first, under random parents: a root that moves freely, a weld joint, oblique
/// axes, rotated offset frames on both sides, a knee whose one coordinate drives five axes (splines, a
/// polynomial, a constant), axes of two factors, couplings in a chain and across joints, coordinates that
/// drive nothing, markers on every body and on the ground, point constraints between bodies and to the
/// ground. SI units.
[[nodiscard]] data::ModelDescription random_tree(std::uint64_t seed);

/// n numbers, even on [-size, size].
[[nodiscard]] Eigen::VectorXd random_vector(Eigen::Index n, double size, Random& random);

/// A state with plain coordinates even on [-1.2, 1.2] and any attitude of free joints.
[[nodiscard]] Eigen::VectorXd random_state(const Model& model, Random& random);

/// Largest difference of two matrices over the largest entry of the second (or 1, whichever is larger).
[[nodiscard]] double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace kinemark::model::testing

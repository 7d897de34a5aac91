// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What every method for joint centres knows of the joints before it sees any motion.
#pragma once

#include <cstdint>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::data {

/// What a joint may do: given as one JointKind for all joints, or found in the recording joint by joint.
enum class JointChoice : std::uint8_t { automatic, ball, hinge };

[[nodiscard]] std::string_view to_string(JointChoice choice);  ///< "auto", "ball", "hinge"
/// The choice of that name; Code::usage with all names otherwise.
[[nodiscard]] Result<JointChoice> parse_joint_choice(std::string_view name);

/// Before any motion is seen a joint is taken to lie within so much (SD per axis, m) of the mean of a
/// segment's markers. It bounds what is said of directions that the motion leaves open.
inline constexpr double kJointPriorSd_m = 0.3;

}  // namespace kinemark::data

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Functions that formulas call.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "kinemark/stages/analysis/segments/segment_graph.h"

namespace kinemark::analysis::internal {

using StepFunction = std::function<void(std::span<const StepValue* const>, StepValue&)>;

/// A function with these types of arguments.
struct FunctionForm {
  std::string_view name;            ///< as formulas call it; operators too
  std::vector<StepType> arguments;  ///< their types
  bool many = false;                ///< the last argument any number of times more
  StepType result = StepType::number;
  StepFunction evaluate;
};

/// All forms; those of one name one after another.
[[nodiscard]] const std::vector<FunctionForm>& function_forms();

/// The frame of a segment: see SegmentDefinition::Segment. Arguments: origin, first and second direction.
[[nodiscard]] StepFunction frame_function(int first, int second);
/// A frame turned about one of its axes. Arguments: frame, angle in rad.
[[nodiscard]] StepFunction turn_function(int axis);
/// An axis (0, 1, 2) or the origin (3) of a frame.
[[nodiscard]] StepFunction part_function(int part);
/// Components of an angle. Arguments: frames of parent and child.
[[nodiscard]] StepFunction angle_function(const SegmentDefinition::Angle& angle);

}  // namespace kinemark::analysis::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the name of a curve over the walking cycle means, and where it stands on a gait report.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"

namespace kinemark::pipeline {

/// Parts of a gait report, each a figure.
enum class SheetPart : std::uint8_t {
  kinematics,  ///< pelvis, hip, knee, ankle, foot: the grid that clinicians know
  others,      ///< all other angles
  kinetics,    ///< moments, powers, ground reaction
};

/// What a curve is of.
struct GaitQuantity {
  std::string key;    ///< "knee_flexion"; of an angle that the field has no name for, that of the curve
  std::string title;  ///< "Knee flexion"
  std::string up;     ///< what positive values are: "flexion"; empty: not known
  std::string down;   ///< what negative values are; empty: not known
  SheetPart part = SheetPart::others;  ///< where it stands
  std::int64_t row = -1;               ///< in the grid; -1: after all that have a place, as it comes
  std::int64_t column = 0;             ///< in the grid
  bool same_sign = false;              ///< positive values are what `up` says by the convention of the name
  std::optional<data::Side> side;      ///< that the name tells
};

/// What the name says: outputs of Plug-in Gait ("LKneeAngles x", "LKneeAngles_flexion", "RHipMoment x"),
/// coordinates of models ("knee_angle_r", "hip_flexion_r_moment"), or a key itself ("knee_flexion").
[[nodiscard]] GaitQuantity gait_quantity(std::string_view name, data::Quantity quantity);

/// The name without side and subject: "KneeAngles x" of "Ann:LKneeAngles x", "knee_angle" of "knee_angle_r".
[[nodiscard]] std::string name_without_side(std::string_view name);

}  // namespace kinemark::pipeline

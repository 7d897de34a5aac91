// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The field's methods for joint centres and axes, one interface.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/functional/constant_distance.h"

namespace kinemark::skeleton {

/// Which of the field's methods places the joints.
enum class FunctionalMethod : std::uint8_t {
  score,              ///< SCoRE for ball joints, SARA for hinges
  sara,               ///< SARA: every joint is a hinge
  gamage,             ///< spheres about a centre, bias corrected
  gamage_plain,       ///< the same without the correction
  cylinder,           ///< circles about an axis
  constant_distance,  ///< the macaque report's
};

/// "score", "sara", "gamage", "gamage-plain", "cylinder", "constant-distance".
[[nodiscard]] std::string_view to_string(FunctionalMethod method);
/// The method of that name; the failure lists all names.
[[nodiscard]] Result<FunctionalMethod> parse_functional_method(std::string_view name);

/// The segments in whose axes the centre is constant. Sphere fits use one and fit the other's markers.
enum class Sides : std::uint8_t { both, parent, child };
[[nodiscard]] std::string_view to_string(Sides sides);  ///< "both", "parent", "child"
/// The choice of that name; the failure lists all names.
[[nodiscard]] Result<Sides> parse_sides(std::string_view name);

/// Options of find_joints().
struct FunctionalOptions {
  FunctionalMethod method = FunctionalMethod::score;  ///< of all joints
  Sides sides = Sides::both;                          ///< which segment holds the centre still
  data::JointChoice kind =
      data::JointChoice::automatic;  ///< of all joints; automatic: by RelativeMotion::kind()
  double noise_sd_m = 0.0;           ///< of the markers, per axis; 0: found from how they keep their shape
  ConstantDistanceOptions constant_distance;  ///< of that method alone
  Array<std::uint8_t> mask;  ///< F x M, 0: the sample is not used (made by the recorder); empty: all are

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// Centres of all joints of a layout, in their segments and in every frame, each with its covariance.
///
/// A segment's pose comes from three of its markers or more that are not on a line; frames without are left
/// out. Where a method cannot be used (two markers on a segment), the nearest one that can is, and the
/// joint's `method` and a warning say so; a joint without any information stays undetermined, with a warning.
/// A centre's covariance is the sum of that of its position in the segments (residuals, blocks of frames left
/// out), of the directions that the motion does not fix, and of the frame's noise, scaled by the gap between
/// the segments.
///
/// Code::bad_input with one sentence when the layout does not fit, has no joint, or not one joint can be
/// placed. O(F M).
[[nodiscard]] Result<data::Skeleton> find_joints(const data::Trajectories& trajectories,
                                                 const data::SegmentLayout& layout,
                                                 const FunctionalOptions& options = {});

}  // namespace kinemark::skeleton

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/animation/joint_tree.h"

namespace kinemark::io::animation {

/// The numbers of all frames of a skeleton: F x C by JointTree::channel_count(), rotations in degrees,
/// lengths in units of the file; NaN where there is none.
struct JointValues {
  std::int64_t frames = 0;
  Array<double> values;
};

/// A unit that a file may be in.
struct FileUnit {
  std::string name;     ///< "cm"
  double metres = 1.0;  ///< per unit
};

/// The one that makes a skeleton whose longest side is `extent` units nearest to 1.7 m in the ratio, and the
/// sentence that says so.
struct UnitChoice {
  FileUnit unit;
  std::string warning;
};
[[nodiscard]] UnitChoice choose_unit(std::string_view why, const std::vector<FileUnit>& units, double extent);

/// Longest side of the box around the points of the first frame that has a number for every channel, in units
/// of the file; 0 where there is none.
[[nodiscard]] double extent_of(const JointTree& tree, const JointValues& values);

/// A number less than which points of a file of so many bytes have: its memory is bounded by its size.
[[nodiscard]] Status check_points(const JointTree& tree, std::int64_t frames, std::size_t bytes);

/// Points in metres, missing where a number is, and the angles as channels. Names that repeat get a number.
[[nodiscard]] data::Trial trial_of(JointTree tree, const JointValues& values, double rate_hz,
                                   double metres_per_unit);

}  // namespace kinemark::io::animation

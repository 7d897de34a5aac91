// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/animation/joint_tree.h"

namespace kinemark::io::animation {

/// A skeleton file. The root comes first; a bone is a joint at its near end, which is no point, and a point
/// at its far end.
struct AsfSkeleton {
  JointTree tree;
  double length = 1.0;  ///< what `length` says under `:units`
};

/// Errors carry the line, not the file.
[[nodiscard]] Result<AsfSkeleton> parse_asf(std::string_view text);

}  // namespace kinemark::io::animation

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/io/animation/internal/words.h"
#include "kinemark/io/animation/joint_tree.h"

namespace kinemark::io::animation {

inline constexpr int kDeepest = 1000;  ///< joints within joints

/// The joints of a BVH file, from HIERARCHY to before MOTION. Errors carry the line, not the file.
[[nodiscard]] Result<JointTree> parse_bvh_hierarchy(TextLines& lines);

}  // namespace kinemark::io::animation

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 in its binary form: a scene that browsers, slides and modelling programs show.
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/animation/pose_tree.h"

namespace kinemark::io {

/// Write markers as a GLB: a node with a small shape for each, whose translation is animated, metres in
/// single precision, y up as the recording has it (nothing is turned here). A marker is hidden, by a scale of
/// 0 that is stepped, in frames where it is missing; between two of its samples it moves on a straight line.
/// Time begins at 0; the first frame's number and time are extras of the scene. Code::bad_input for a trial
/// that is not valid or empty, Code::not_supported for more than 4 GiB; Code::io as OutputFile.
[[nodiscard]] Status write_glb(const std::filesystem::path& path, const data::Trial& trial, bool force);

/// Write the motion of bodies as a GLB: the tree of nodes with their rotations as quaternions, and
/// translations where a body's origin moves in the axes of the one above. From each body's origin a shape
/// leads to those that hang from it, or to its end. Else as above.
[[nodiscard]] Status write_glb(const std::filesystem::path& path, const PoseTree& poses, bool force);

}  // namespace kinemark::io

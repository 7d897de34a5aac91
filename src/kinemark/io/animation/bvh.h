// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/animation/pose_tree.h"

namespace kinemark::io {

/// Read a BVH file: joints and end sites as points (an end site is "<joint>_end"), in metres, and the angles
/// of every joint as a channel "<joint>_angles_ZXY" in degrees, its components in the order of the name.
///
/// The file states no unit: metres, centimetres or millimetres, whichever makes the skeleton of the first
/// frame nearest to the size of a person, which a warning says. Numbers that move a joint are added to its
/// offset; below the root they stand for it where those of the first frame are nearer to the offsets than to
/// zero, as many programs write them (warning). A frame time of few digits becomes the whole rate that it was
/// rounded from. Fewer or more frames than announced are a warning, and so is a last row that ends early,
/// which is left out.
///
/// Code::bad_input, with the line, for a hierarchy that is not closed, channels that are none, joints nested
/// more than 1,000 deep, a row with too few or too many numbers, text where a number belongs, no frames.
/// Code::io when it cannot be read. Memory: the text, and 25 bytes a point and frame, of which there are at
/// most as many as bytes.
[[nodiscard]] Result<data::Trial> read_bvh(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] Result<data::Trial> parse_bvh(std::string_view text, std::string_view name);

/// Write the motion of bodies as a BVH file: a joint for each body, at its origin, its rotation in the order
/// z, x, y; centimetres. A body whose origin moves in the axes of the one above has positions too, and no
/// offset, so that readers that add both and readers that take the one for the other agree. A body that
/// carries none ends in an End Site. Where several bodies hang from the laboratory they hang from a joint
/// "laboratory". Blanks and braces in names become "_". Positions are rounded to 1e-8 m, angles to 1e-6 deg.
/// Code::bad_input for what is not valid; Code::io as OutputFile.
[[nodiscard]] Status write_bvh(const std::filesystem::path& path, const PoseTree& poses, bool force);

}  // namespace kinemark::io

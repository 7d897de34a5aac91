// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/pose_table.h"

namespace kinemark::io::internal {

/// Whether a file holds points in images as SLEAP (also its projects) or DeepLabCut keep them.
[[nodiscard]] bool holds_poses(Input& in);

/// read_pose_table() of a file that is open.
[[nodiscard]] Result<PoseTable> read_pose_table(Input& in);

/// read_pose_table() in this process, as read_nwb_here().
[[nodiscard]] Result<PoseTable> read_pose_table_here(const std::filesystem::path& path);

/// An analysis file of SLEAP, with `tracks` in its root.
[[nodiscard]] Result<PoseTable> read_sleap(Input& in);

/// A DataFrame that pandas wrote into this group, in its format `table` or `fixed`.
[[nodiscard]] Result<PoseTable> read_deeplabcut(Input& in, hid_t group);

/// A table of DeepLabCut from the labels of its columns, (scorer, bodypart, coord) or (scorer, individual,
/// bodypart, coord), and its rows; the numbers of its frames must be 0, 1, 2, ...
[[nodiscard]] Result<PoseTable> arrange_columns(const std::vector<std::vector<std::string>>& columns,
                                                const Array<double>& frame_numbers,
                                                const Array<double>& rows);

}  // namespace kinemark::io::internal

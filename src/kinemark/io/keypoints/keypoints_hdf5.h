// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/io/nwb/pose_table.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io {

/// The points of one person of a table: of the only one that is seen in any frame, or of the one that is
/// chosen by her place among the tracks or individuals, from 1. Several where none is chosen:
/// Code::not_supported with their names; nobody, and points that no CSV would be read with: Code::bad_input.
[[nodiscard]] Result<Keypoints> points_of_person(const PoseTable& table,
                                                 const KeypointsOptions& options = {});

/// Analysis files of SLEAP and tables of DeepLabCut in HDF5 (read_pose_table()).
[[nodiscard]] Result<Keypoints> read_keypoints_hdf5(const std::filesystem::path& path,
                                                    const KeypointsOptions& options = {});

}  // namespace kinemark::io

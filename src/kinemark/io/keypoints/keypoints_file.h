// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io {

/// Points in the images of one camera, of whatever made them: a folder of OpenPose or a file of it
/// (read_openpose()), JSON of MMPose and COCO (parse_keypoints_json()), HDF5 of SLEAP and DeepLabCut
/// (read_keypoints_hdf5()), otherwise CSV (read_keypoints_csv()).
[[nodiscard]] Result<Keypoints> read_keypoints(const std::filesystem::path& path,
                                               const KeypointsOptions& options = {});

/// Whether a file with this beginning, its first 512 bytes, is one that read_keypoints() reads.
[[nodiscard]] bool begins_keypoints(std::string_view begin);

/// The files that read_keypoints() reads of a path: all frames of OpenPose, otherwise the path alone.
[[nodiscard]] Result<std::vector<std::filesystem::path>> keypoints_files(const std::filesystem::path& path);

}  // namespace kinemark::io

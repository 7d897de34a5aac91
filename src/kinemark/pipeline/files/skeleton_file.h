// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The skeleton.json that `kinemark joints` writes, read back: segments, joint centres and axes with their
// covariance, without the frames.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/skeleton.h"

namespace kinemark::pipeline {

/// A skeleton and the recording that it was found in.
struct SkeletonFile {
  data::Skeleton skeleton;    ///< no frames; NaN where the file has null
  data::InputFile recording;  ///< path and hash, as the file names them; empty where it names none
};

/// Read skeleton.json, or the one in a folder that `kinemark joints` wrote. Code::bad_input with file and
/// place for what is no skeleton; a file beyond 64 MB is refused.
[[nodiscard]] Result<SkeletonFile> read_skeleton(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file.
[[nodiscard]] Result<SkeletonFile> parse_skeleton(std::string_view text, const std::string& name);

}  // namespace kinemark::pipeline

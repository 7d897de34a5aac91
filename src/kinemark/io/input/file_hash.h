// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"

namespace kinemark::io {

/// Size and checksum of a file.
struct FileHash {
  std::int64_t bytes = 0;  ///< size
  std::string hex;         ///< XXH3, 64 bits, 16 lower-case digits
};

/// Size and checksum of a file, read once in blocks.
[[nodiscard]] Result<FileHash> hash_file(const std::filesystem::path& path);

/// Size and checksum of files one after the other, as of one file with all their bytes.
[[nodiscard]] Result<FileHash> hash_files(std::span<const std::filesystem::path> paths);

/// Size and checksum of a file as a run's record has them.
/// @param role  "markers", "model", "setup", ...
[[nodiscard]] Result<data::InputFile> record_input(const std::string& role,
                                                   const std::filesystem::path& path);

/// The same for what several files tell together, recorded under one path, such as their folder.
[[nodiscard]] Result<data::InputFile> record_inputs(const std::string& role,
                                                    const std::filesystem::path& path,
                                                    std::span<const std::filesystem::path> files);

}  // namespace kinemark::io

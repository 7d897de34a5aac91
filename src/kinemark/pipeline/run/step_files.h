// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which files a command had to do with, by what it said and by what its results say.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::pipeline {

/// A file and the checksum of its content.
using HashedFile = std::pair<std::string, std::string>;

/// The files of the lines "wrote FILE".
[[nodiscard]] std::vector<std::filesystem::path> written_files(const std::vector<std::string>& said);

/// The files that results name as what they were made from: "inputs" of a .json among them, with checksums
/// as they were then. Results that are no such JSON name none. @param base  folder from which paths count
[[nodiscard]] std::vector<HashedFile> named_inputs(const std::vector<std::filesystem::path>& results,
                                                   const std::filesystem::path& base);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The files that are meant when files and folders are given.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Endings of the files that hold markers, in lower case.
[[nodiscard]] std::vector<std::string> marker_endings();
/// Endings of all files that run_info() reads, in lower case.
[[nodiscard]] std::vector<std::string> known_endings();

/// Files to read.
struct InputList {
  std::vector<std::filesystem::path> files;  ///< in the order given, those of a folder by name
  std::vector<std::string> notes;            ///< what was passed over in which folder, one sentence each
};

/// The files as given, and in the place of each folder the files directly in it whose names have one of the
/// endings, in any case; others are counted, hidden ones are not. Files are not opened, nor looked for.
///
/// @param endings  in lower case, with their dots
/// @return         Code::bad_input for a folder without such a file, Code::io for one that cannot be read
[[nodiscard]] Result<InputList> list_inputs(const std::vector<std::filesystem::path>& given,
                                            const std::vector<std::string>& endings);

}  // namespace kinemark::pipeline

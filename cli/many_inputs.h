// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Several files and folders where a command takes one file.
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/pipeline/files/input_list.h"

namespace kinemark::cli {

/// More than one input, or a folder.
[[nodiscard]] bool are_many(const std::vector<std::filesystem::path>& given);

}  // namespace kinemark::cli

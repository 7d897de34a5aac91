// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// This program as a process of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/run/run_job.h"

namespace kinemark::cli {

/// Run this program with other words in a folder and wait for it. What it prints on stdout is dropped, the
/// lines that it prints on stderr are kept (the last 1,000). It is ended with the process that started it.
/// Code::io where it cannot be started, or where a signal ended it.
[[nodiscard]] Result<pipeline::CommandEnd> run_child(const std::vector<std::string>& words,
                                                     const std::filesystem::path& folder);

}  // namespace kinemark::cli

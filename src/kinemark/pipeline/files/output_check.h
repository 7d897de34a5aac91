// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where results must not go.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// Code::usage, naming the output, when one of the outputs is one of the inputs: the same file, under
/// whatever name and through whatever link. Names that are empty or of nothing that is there do not count.
[[nodiscard]] Status check_apart(const std::vector<std::filesystem::path>& outputs,
                                 const std::vector<std::filesystem::path>& inputs);
/// The same for what a job writes without Staging: its inputs and those that its caller gives (`job.kept`).
[[nodiscard]] Status check_apart(const JobSettings& job, const std::vector<std::filesystem::path>& outputs,
                                 const std::vector<std::filesystem::path>& inputs);

/// The ending of an output is one that its job writes, or there is none: Code::usage, naming those,
/// otherwise.
/// @param what  is written: "joint angles"
[[nodiscard]] Status check_ending(const std::filesystem::path& output,
                                  const std::vector<std::string>& endings, std::string_view what);

/// Results that go into a folder get one: Code::usage for a name that ends as a file does, unless a folder of
/// that name is there. Empty: nothing is written.
[[nodiscard]] Status check_folder(const std::filesystem::path& output, std::string_view what);

}  // namespace kinemark::pipeline

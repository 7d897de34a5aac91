// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/output_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/input_list.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Status check_apart(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  std::error_code absent;
  for (const auto& output : outputs)
    for (const auto& input : inputs)
      if (fs::equivalent(output, input, absent))
        return fail(Code::usage, fmt::format("{}: is the file that is read as {}; name another output",
                                             output.string(), input.string()));
  return {};
}

Status check_apart(const JobSettings& job, const std::vector<fs::path>& outputs,
                   const std::vector<fs::path>& inputs) {
  if (auto s = check_apart(outputs, inputs); !s) return s;
  return check_apart(outputs, job.kept);
}

Status check_ending(const fs::path& output, const std::vector<std::string>& endings, std::string_view what) {
  const auto ending = ending_of(output);
  if (ending.empty() || std::ranges::find(endings, ending) != endings.end()) return {};
  return fail(Code::usage, fmt::format("{}: {} written as {}; '{}' is another ending", output.string(), what,
                                       join(endings, " or "), ending));
}

Status check_folder(const fs::path& output, std::string_view what) {
  std::error_code absent;
  auto files = known_endings();
  for (const char* other : {".csv", ".json", ".html", ".xml", ".toml", ".txt"}) files.emplace_back(other);
  const auto ending = ending_of(output);
  if (std::ranges::find(files, ending) == files.end() || fs::is_directory(output, absent)) return {};
  return fail(Code::usage, fmt::format("{}: {} written into a folder; '{}' is the ending of a file",
                                       output.string(), what, ending));
}

}  // namespace kinemark::pipeline

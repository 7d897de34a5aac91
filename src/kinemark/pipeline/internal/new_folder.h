// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ranges>
#include <system_error>
#include <vector>

#include "kinemark/io/temporary.h"

namespace kinemark::pipeline {

/// Creates a folder and its parents; those that were created are removed again if they stay empty, also where
/// a signal ends the program.
class NewFolder {
 public:
  explicit NewFolder(std::filesystem::path folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> missing;  // innermost first
    for (folder = std::filesystem::absolute(folder, ignored).lexically_normal();
         folder.has_relative_path() && !std::filesystem::exists(folder, ignored);
         folder = folder.parent_path())
      missing.push_back(folder);
    for (const auto& outer : std::views::reverse(missing))
      made_.push_back(io::Temporary::watch_folder(outer));
    if (!missing.empty()) std::filesystem::create_directories(missing.front(), error_);
  }
  ~NewFolder() {
    while (!made_.empty()) made_.pop_back();
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  [[nodiscard]] const std::error_code& error() const { return error_; }
  /// Those that were not there before, outermost first.
  [[nodiscard]] std::vector<std::filesystem::path> made() const {
    std::vector<std::filesystem::path> out;
    for (const auto& folder : made_) out.push_back(folder.path());
    return out;
  }

 private:
  std::vector<io::Temporary> made_;  ///< outermost first
  std::error_code error_;
};

}  // namespace kinemark::pipeline

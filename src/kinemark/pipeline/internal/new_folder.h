// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <system_error>
#include <vector>

namespace kinemark::pipeline {

/// Creates a folder and its parents; those that were created are removed again if they stay empty.
class NewFolder {
 public:
  explicit NewFolder(std::filesystem::path folder) {
    std::error_code ignored;
    for (folder = std::filesystem::absolute(folder, ignored).lexically_normal();
         folder.has_relative_path() && !std::filesystem::exists(folder, ignored);
         folder = folder.parent_path())
      made_.push_back(folder);
    if (!made_.empty()) std::filesystem::create_directories(made_.front(), error_);
  }
  ~NewFolder() {
    std::error_code ignored;
    for (const auto& folder : made_) std::filesystem::remove(folder, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  [[nodiscard]] const std::error_code& error() const { return error_; }

 private:
  std::vector<std::filesystem::path> made_;  ///< innermost first
  std::error_code error_;
};

}  // namespace kinemark::pipeline

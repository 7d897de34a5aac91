// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/staging.h"

#include <fmt/core.h>

#include <cstdlib>
#include <system_error>
#include <utility>

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Result<Staging> Staging::create(std::vector<fs::path> targets, bool force) {
  std::error_code ignored;
  for (const auto& target : targets) {
    if (fs::is_directory(target, ignored))
      return fail(Code::io, fmt::format("{}: is a folder; need a file name", target.string()));
    if (!force && fs::exists(target, ignored))
      return fail(Code::io, fmt::format("{}: exists already; use --force to replace it", target.string()));
  }
  Staging staging;
  const fs::path parent = targets.front().has_parent_path() ? targets.front().parent_path() : fs::path(".");
  std::string pattern = (parent / ".kinemark-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    return fail(Code::io, fmt::format("{}: cannot be written ({})", targets.front().string(),
                                      std::generic_category().message(errno)));
  staging.folder_ = pattern;
  staging.targets_ = std::move(targets);
  return staging;
}

Staging::Staging(Staging&& other) noexcept
    : folder_(std::exchange(other.folder_, {})), targets_(std::move(other.targets_)) {}

Staging::~Staging() {
  if (folder_.empty()) return;
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path Staging::path(std::size_t i) const {
  return folder_ / fmt::format("{}-{}", i, targets_.at(i).filename().string());
}

Status Staging::commit() {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    std::error_code error;
    if (!fs::exists(path(i))) continue;
    fs::rename(path(i), targets_[i], error);
    if (error == std::errc::cross_device_link)
      fs::copy_file(path(i), targets_[i], fs::copy_options::overwrite_existing, error);
    if (error)
      return fail(Code::io, fmt::format("{}: cannot be written ({})", targets_[i].string(), error.message()));
  }
  return {};
}

}  // namespace kinemark::pipeline

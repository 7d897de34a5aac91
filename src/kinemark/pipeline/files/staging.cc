// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/staging.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/pipeline/internal/new_folder.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

namespace {

fs::path parent_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

}  // namespace

Result<Staging> Staging::create(std::vector<fs::path> targets, bool force) {
  std::error_code ignored;
  std::set<fs::path> seen;
  for (const auto& target : targets) {
    if (fs::is_directory(target, ignored))
      return fail(Code::io, fmt::format("{}: is a folder; need a file name", target.string()));
    if (!force && fs::exists(target, ignored))
      return fail(Code::io, fmt::format("{}: exists already; use --force to replace it", target.string()));
    if (!seen.insert(fs::absolute(target, ignored).lexically_normal()).second)
      return fail(Code::usage, fmt::format("{}: would be written twice; name another file", target.string()));
  }
  Staging staging;
  for (const auto& target : targets) {
    const fs::path parent = parent_of(target);
    if (staging.folders_.contains(parent)) continue;
    std::string pattern = (parent / ".kinemark-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      return fail(Code::io, fmt::format("{}: cannot be written ({})", target.string(),
                                        std::generic_category().message(errno)));
    staging.folders_[parent] = pattern;
  }
  staging.targets_ = std::move(targets);
  return staging;
}

Result<Staging> Staging::create_in(const fs::path& folder, const std::vector<std::string>& names,
                                   bool force) {
  auto made = std::make_unique<NewFolder>(folder);
  if (made->error())
    return fail(Code::io, fmt::format("{}: cannot be made ({})", folder.string(), made->error().message()));
  std::vector<fs::path> targets;
  for (const auto& name : names) targets.push_back(folder / name);
  auto staging = create(std::move(targets), force);
  if (staging) staging->made_ = std::move(made);
  return staging;
}

Staging::Staging() = default;

Staging::Staging(Staging&& other) noexcept
    : made_(std::move(other.made_)),
      folders_(std::exchange(other.folders_, {})),
      targets_(std::move(other.targets_)) {}

Staging::~Staging() {
  std::error_code ignored;
  for (const auto& [parent, folder] : folders_) fs::remove_all(folder, ignored);
}

fs::path Staging::path(std::size_t i) const {
  return folders_.at(parent_of(targets_.at(i))) / fmt::format("{}-{}", i, targets_.at(i).filename().string());
}

fs::path Staging::path_of(const fs::path& target) const {
  const auto found = std::ranges::find(targets_, target);
  check(found != targets_.end(), "path_of() needs a target of the staging");
  return path(static_cast<std::size_t>(found - targets_.begin()));
}

std::vector<fs::path> Staging::written() const {
  std::vector<fs::path> out;
  for (std::size_t i = 0; i < targets_.size(); ++i)
    if (fs::exists(path(i))) out.push_back(targets_[i]);
  return out;
}

std::unexpected<Error> Staging::failure(Error error) const {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const std::string staged = path(i).string();
    if (const auto at = error.message.find(staged); at != std::string::npos)
      error.message.replace(at, staged.size(), targets_[i].string());
  }
  return std::unexpected(std::move(error));
}

Status Staging::commit() {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    std::error_code error;
    if (!fs::exists(path(i))) continue;
    fs::rename(path(i), targets_[i], error);
    if (error)
      return fail(Code::io, fmt::format("{}: cannot be written ({})", targets_[i].string(), error.message()));
  }
  return {};
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/staging.h"

#include <fmt/core.h>

#include <algorithm>
#include <ranges>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/io/place.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/internal/new_folder.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

Status Staging::find_targets() {
  std::error_code ignored;
  std::set<fs::path> seen;
  for (const auto& target : targets_) {
    auto resolved = io::find_target(target, force_);
    if (!resolved) return std::unexpected(resolved.error());
    if (!seen.insert(fs::absolute(*resolved, ignored).lexically_normal()).second)
      return fail(Code::usage, fmt::format("{}: would be written twice; name another file", target.string()));
    resolved_.push_back(std::move(*resolved));
  }
  return {};
}

Result<Staging> Staging::create(std::vector<fs::path> targets, const JobSettings& job,
                                const std::vector<fs::path>& inputs) {
  if (auto s = check_apart(job, targets, inputs); !s) return std::unexpected(s.error());
  Staging staging;
  staging.force_ = job.force;
  staging.inputs_ = job.kept;
  staging.add_inputs(inputs);
  staging.targets_ = std::move(targets);
  if (auto s = staging.find_targets(); !s) return std::unexpected(s.error());
  for (std::size_t i = 0; i < staging.resolved_.size(); ++i) {
    const auto& target = staging.resolved_[i];
    if (staging.folders_.contains(target.parent_path())) continue;
    auto folder = io::Temporary::folder_for(target);
    if (!folder) return std::unexpected(folder.error());
    staging.folders_.emplace(target.parent_path(), std::move(*folder));
  }
  return staging;
}

Result<Staging> Staging::create_in(const fs::path& folder, const std::vector<std::string>& names,
                                   const JobSettings& job, const std::vector<fs::path>& inputs) {
  auto made = std::make_unique<NewFolder>(folder);
  if (made->error())
    return fail(Code::io, fmt::format("{}: cannot be made ({})", folder.string(), made->error().message()));
  std::vector<fs::path> targets;
  for (const auto& name : names) targets.push_back(folder / name);
  auto staging = create(std::move(targets), job, inputs);
  if (staging) staging->made_ = std::move(made);
  return staging;
}

Staging::Staging() = default;
Staging::Staging(Staging&& other) noexcept = default;
Staging::~Staging() = default;

fs::path Staging::path(std::size_t i) const {
  return folders_.at(resolved_.at(i).parent_path()).path() /
         fmt::format("{}-{}", i, targets_[i].filename().string());
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

void Staging::add_inputs(const std::vector<fs::path>& inputs) {
  inputs_.insert(inputs_.end(), inputs.begin(), inputs.end());
}

void Staging::add_inputs(const std::vector<data::InputFile>& inputs) {
  for (const auto& input : inputs) inputs_.emplace_back(input.path);
}

Status Staging::place_all() {
  std::vector<std::pair<std::size_t, io::Replaced>> done;
  const auto held = io::hold_end();
  // The first comes last: where it is, all are.
  for (std::size_t i = targets_.size(); i-- > 0;) {
    if (!fs::exists(path(i))) continue;
    const auto placed = io::place_file(path(i), resolved_[i], force_, true);
    if (placed) {
      done.emplace_back(i, *placed);
      continue;
    }
    for (const auto& [back, how] : std::views::reverse(done))
      io::unplace_file(path(back), resolved_[back], how);
    return std::unexpected(placed.error());
  }
  return {};
}

Status Staging::commit() {
  if (auto s = check_apart(targets_, inputs_); !s) return s;
  if (auto s = place_all(); !s) return s;
  for (const auto& [parent, hidden] : folders_)
    if (auto s = io::sync_folder(parent); !s) return s;
  return {};
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/staging.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <ranges>
#include <system_error>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/io/place.h"
#include "kinemark/io/placement.h"
#include "kinemark/io/temporary.h"
#include "kinemark/pipeline/files/output_check.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

namespace {

fs::path normal_path(const fs::path& path) {
  std::error_code ignored;
  return fs::absolute(path, ignored).lexically_normal();
}

}  // namespace

/// Creates a folder and its parents; those that were created are removed again if they stay empty, also where
/// a signal ends the program.
class NewFolder {
 public:
  explicit NewFolder(fs::path folder) {
    std::error_code ignored;
    std::vector<fs::path> missing;  // innermost first
    for (folder = fs::absolute(folder, ignored).lexically_normal();
         folder.has_relative_path() && !fs::exists(folder, ignored); folder = folder.parent_path())
      missing.push_back(folder);
    for (const auto& outer : std::views::reverse(missing))
      made_.push_back(io::Temporary::watch_folder(outer));
    if (!missing.empty()) fs::create_directories(missing.front(), error_);
  }
  ~NewFolder() {
    while (!made_.empty()) made_.pop_back();
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  [[nodiscard]] const std::error_code& error() const { return error_; }
  /// Those that were not there before, outermost first.
  [[nodiscard]] std::vector<fs::path> made() const {
    std::vector<fs::path> out;
    for (const auto& folder : made_) out.push_back(folder.path());
    return out;
  }

 private:
  std::vector<io::Temporary> made_;  ///< outermost first
  std::error_code error_;
};

Status Staging::add_target(const fs::path& target) {
  // What a killed run left is no result that is in the way.
  if (const auto parent = target.parent_path(); !folders_.contains(parent))
    io::remove_leftovers(parent.empty() ? "." : parent);
  auto resolved = io::find_target(target, force_);
  if (!resolved) return std::unexpected(resolved.error());
  const auto is_it = [&](const StagedFile& file) {
    return normal_path(file.target) == normal_path(*resolved);
  };
  if (std::ranges::any_of(files_, is_it))
    return fail(Code::usage, fmt::format("{}: would be written twice; name another file", target.string()));
  const auto parent = resolved->parent_path();
  if (!folders_.contains(parent)) {
    auto folder = io::Temporary::folder_for(*resolved);
    if (!folder) return std::unexpected(folder.error());
    folders_.emplace(parent, std::move(*folder));
  }
  auto staged = folders_.at(parent).path() / target.filename();
  // Two links may lead to two files of one folder.
  if (std::ranges::find(files_, staged, &StagedFile::staged) != files_.end() ||
      target.filename() == io::kPlacementRecord)
    staged = staged.parent_path() / fmt::format("{}-{}", files_.size(), target.filename().string());
  targets_.push_back(target);
  files_.push_back({.target = std::move(*resolved), .staged = std::move(staged)});
  return {};
}

Status Staging::add(const std::vector<fs::path>& targets) {
  if (auto s = check_apart(targets, inputs_); !s) return s;
  for (const auto& target : targets)
    if (auto s = add_target(target); !s) return s;
  return {};
}

Status Staging::add_in(const fs::path& folder, const std::vector<std::string>& names) {
  made_.push_back(std::make_unique<NewFolder>(folder));
  if (const auto& error = made_.back()->error())
    return fail(Code::io, fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
  std::vector<fs::path> targets;
  for (const auto& name : names) targets.push_back(folder / name);
  return add(targets);
}

Status Staging::add_page(const fs::path& page) {
  if (page.empty()) return {};
  if (ending_of(page) != ".html")
    return fail(Code::usage, fmt::format("{}: a page ends in .html; '{}' is another ending", page.string(),
                                         ending_of(page)));
  return add({page});
}

Result<Staging> Staging::create(const std::vector<fs::path>& targets, const JobSettings& job,
                                const std::vector<fs::path>& inputs) {
  Staging staging;
  staging.force_ = job.force;
  staging.inputs_ = inputs;
  staging.add_inputs(job.kept);
  if (auto s = staging.add(targets); !s) return std::unexpected(s.error());
  return staging;
}

Result<Staging> Staging::create_in(const fs::path& folder, const std::vector<std::string>& names,
                                   const JobSettings& job, const std::vector<fs::path>& inputs) {
  auto staging = create({}, job, inputs);
  if (!staging) return staging;
  if (auto s = staging->add_in(folder, names); !s) return std::unexpected(s.error());
  return staging;
}

Staging::Staging() = default;
Staging::Staging(Staging&& other) noexcept = default;

Staging::~Staging() {
  folders_.clear();
  while (!made_.empty()) made_.pop_back();  // the inner before the outer
}

fs::path Staging::path(std::size_t i) const { return files_.at(i).staged; }

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

Status Staging::commit() {
  if (auto s = check_apart(targets_, inputs_); !s) return s;
  std::vector<io::FileToPlace> files;
  // The first comes last: where it is, all are.
  for (const auto& file : std::views::reverse(files_))
    if (fs::exists(file.staged)) files.push_back({.staged = file.staged, .target = file.target});
  std::vector<fs::path> made;
  for (const auto& folder : made_) std::ranges::copy(folder->made(), std::back_inserter(made));
  return io::place_files(files, force_, made);
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_files.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "kinemark/pipeline/files/input_list.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;

/// What stems of companions end in.
constexpr std::array<std::string_view, 8> kCompanions = {
    "_tau_sd", "_sd", "_bound", "_tau", "_marker_errors", "_marker_locations", "_rank", "_derivatives"};

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::optional<Stamp> stamp_of(const fs::path& file) {
  struct stat found{};
  if (::stat(file.c_str(), &found) != 0) return std::nullopt;
  return Stamp{.bytes = found.st_size,
               .changed_ns = nanoseconds(found.st_mtim),
               .renewed_ns = nanoseconds(found.st_ctim),
               .node = found.st_ino};
}

std::vector<std::string> trial_endings() {
  auto endings = pipeline::known_endings();
  std::erase(endings, ".osim");
  return endings;
}

bool is_companion(const fs::path& file, const std::vector<fs::path>& all) {
  if (pipeline::ending_of(file) != ".sto") return false;
  const std::string stem = file.stem().string();
  return std::ranges::any_of(kCompanions, [&](std::string_view suffix) {
    if (!stem.ends_with(suffix)) return false;
    const auto whose = stem.substr(0, stem.size() - suffix.size());
    return std::ranges::any_of(all, [&](const auto& other) { return other.stem().string() == whose; });
  });
}

/// What lies beside a trial and is read with it.
constexpr std::array<const char*, 4> kBeside = {"_report.json", "_sd.sto", "_marker_errors.sto",
                                                "_edits.jsonl"};

}  // namespace

bool leads_out(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() != fs::file_type::symlink) return false;
  const auto top = fs::canonical(folder, error), end = fs::weakly_canonical(file, error);
  return error || std::mismatch(top.begin(), top.end(), end.begin(), end.end()).first != top.end();
}

namespace {

/// The trial itself or something beside it that is read, and written, with it is a link out of the folder.
bool any_leads_out(const fs::path& folder, const fs::path& trial) {
  return leads_out(folder, trial) || std::ranges::any_of(kBeside, [&](const char* suffix) {
           return leads_out(folder, pipeline::beside(trial, suffix));
         });
}

}  // namespace

Stamps stamps_of(const fs::path& trial) {
  Stamps stamps{stamp_of(trial)};
  for (const char* suffix : kBeside) stamps.push_back(stamp_of(pipeline::beside(trial, suffix)));
  return stamps;
}

TrialFiles::TrialFiles(std::vector<fs::path> given) : given_(std::move(given)) {}

std::uint32_t TrialFiles::number_of(const fs::path& path, const fs::path& folder) {
  const auto [at, is_new] = numbers_.try_emplace(path, static_cast<std::uint32_t>(known_.size() + 1));
  if (is_new) known_.push_back({path, folder});
  return at->second;
}

TrialListing TrialFiles::list() {
  TrialListing listing;
  for (const auto& given : given_) {
    const auto found = pipeline::list_inputs({given}, trial_endings());
    if (!found) {
      listing.notes.push_back(found.error().message);
      continue;
    }
    const bool is_folder = found->files.size() != 1 || found->files.front() != given;
    const std::scoped_lock lock(mutex_);
    for (const auto& file : found->files) {
      if (is_folder && is_companion(file, found->files)) continue;
      if (is_folder && any_leads_out(given, file))
        listing.notes.push_back(fmt::format(
            "{}: a link leads out of the folder; what it leads to is not shown unless it is given itself",
            file.filename().string()));
      else
        listing.trials.push_back({number_of(file, is_folder ? given : fs::path()), file});
    }
  }
  // A file may be given besides its folder.
  std::vector<std::uint32_t> seen;
  std::erase_if(listing.trials, [&](const TrialFile& trial) {
    if (std::ranges::find(seen, trial.number) != seen.end()) return true;
    seen.push_back(trial.number);
    return false;
  });
  return listing;
}

std::optional<fs::path> TrialFiles::path_of(std::uint32_t number) const {
  const std::scoped_lock lock(mutex_);
  if (number == 0 || number > known_.size()) return std::nullopt;
  const auto& known = known_[number - 1];
  if (!known.folder.empty() && any_leads_out(known.folder, known.path)) return std::nullopt;
  return known.path;
}

Status check_given(const std::vector<fs::path>& given) {
  for (const auto& path : given) {
    std::error_code error;
    if (!fs::exists(path, error))
      return fail(Code::io, fmt::format("{}: cannot be opened ({})", path.string(),
                                        error ? error.message() : "there is no such file or folder"));
  }
  const auto listing = TrialFiles(given).list();
  if (listing.trials.empty() && !listing.notes.empty()) return fail(Code::bad_input, listing.notes.front());
  return {};
}

}  // namespace kinemark::server

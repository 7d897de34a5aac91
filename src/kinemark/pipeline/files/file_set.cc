// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_set.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "kinemark/io/file.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/set_mark.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBlock = 1UL << 20;
/// All formats but NWB name their set near the beginning.
constexpr std::size_t kSearched = 4UL << 20;

/// What follows the stem of a result's first file.
constexpr std::array<std::string_view, 13> kEndings = {
    "_tau_sd.sto",           "_sd.sto",   "_bound.sto",  "_tau.sto",     "_marker_errors.sto",
    "_marker_locations.sto", "_rank.sto", "_levels.sto", "_report.json", "_derivatives.sto",
    "_skeleton.json",        ".mot",      ".osim"};
/// Results that have a folder of their own, by the names there: of `joints`, of `simulate`. Models are left
/// out: one is replaced by its scaled one.
using Names = std::array<std::string_view, 5>;
constexpr std::array<Names, 3> kFolders = {
    Names{"centres.c3d", "segments.toml", "skeleton.json"},
    Names{"markers.c3d", "markers.trc", "truth.mot", "truth.trc"},
    Names{"recording.mcap", "truth.trc", "truth_derivatives.sto", "rig_true.toml", "rig_nominal.toml"}};

/// Whether a file was changed since it was written; of those that hold a sum (io/seal.h).
bool is_changed(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kSealed = {".mot", ".sto", ".json", ".trc"};
  if (std::ranges::find(kSealed, ending_of(file)) == kSealed.end()) return false;
  const auto text = io::read_text(file);
  return text && io::check_seal(*text) == io::Seal::broken;
}

std::string name_changed(const fs::path& file) {
  return fmt::format("{}: {}", file.string(), io::broken_seal());
}

std::string name_strangers(const fs::path& file, const fs::path& other) {
  return fmt::format(
      "{}: was not written together with {}: a run was interrupted while it replaced them, or one of them "
      "comes from elsewhere; make them anew",
      other.string(), file.string());
}

/// The stem of the result that a file belongs to.
std::string stem_of_result(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const auto ending : kEndings)
    if (name.size() > ending.size() && name.ends_with(ending))
      return name.substr(0, name.size() - ending.size());
  return file.stem().string();
}

/// Files that are there and by their names belong to one result with this one.
std::vector<fs::path> files_beside(const fs::path& file) {
  std::vector<fs::path> out;
  const std::string stem = stem_of_result(file), name = file.filename().string();
  std::error_code ignored;
  const auto look_at = [&](const fs::path& other) {
    if (other.filename() != file.filename() && std::ranges::find(out, other) == out.end() &&
        fs::is_regular_file(other, ignored))
      out.push_back(other);
  };
  for (const auto ending : kEndings) look_at(file.parent_path() / (stem + std::string(ending)));
  for (const auto& names : kFolders)
    if (std::ranges::find(names, name) != names.end())
      for (const auto other : names) look_at(file.parent_path() / other);
  return out;
}

}  // namespace

SetDigest::SetDigest() : state_(XXH3_createState()) { XXH3_64bits_reset(state_.get()); }

void SetDigest::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

SetDigest& SetDigest::add(std::string_view text) {
  const std::uint64_t size = text.size();
  XXH3_64bits_update(state_.get(), &size, sizeof size);
  XXH3_64bits_update(state_.get(), text.data(), text.size());
  return *this;
}

SetDigest& SetDigest::add(std::span<const double> numbers) {
  return add(std::string_view(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()));
}

SetDigest& SetDigest::add(const data::Table& table) {
  add(table.name);
  for (const auto& column : table.columns) add(column);
  return add(std::span<const double>(table.time_s)).add(std::span<const double>(table.values));
}

SetDigest& SetDigest::add(const data::Trajectories& markers) {
  for (const auto& name : markers.names) add(name);
  const std::array clock{markers.time.rate_hz, markers.time.t0_s, static_cast<double>(markers.time.frames)};
  return add(std::span<const double>(clock))
      .add(std::span<const double>(markers.x_in_world))
      .add(std::string_view(reinterpret_cast<const char*>(markers.state.data()), markers.state.size()));
}

SetDigest& SetDigest::add(const std::vector<data::InputFile>& inputs) {
  for (const auto& input : inputs) add(input.role).add(input.hash);
  return *this;
}

SetDigest& SetDigest::add(const std::vector<std::pair<std::string, std::string>>& options) {
  for (const auto& [name, value] : options) add(name).add(value);
  return *this;
}

std::string SetDigest::hex() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_.get())); }

std::string set_in(const fs::path& path) {
  const auto file = io::InputFile::open(path);
  if (!file) return {};
  const std::size_t size = ending_of(path) == ".nwb" ? file->size() : std::min(file->size(), kSearched);
  std::string block(kBlock, '\0');
  // Blocks overlap, so that no mark is cut.
  for (std::size_t at = 0; at < size; at += kBlock - 64) {
    const auto n = file->read_at(at, std::as_writable_bytes(std::span(block)));
    if (!n) return {};
    const auto text = std::string_view(block).substr(0, *n);
    if (const auto digits = io::find_mark(text, io::kSetKey); digits != std::string_view::npos)
      return std::string(text.substr(digits, io::kNoSum.size()));
  }
  return {};
}

Status check_same_set(const std::vector<SetMember>& members) {
  for (const auto& member : members)
    if (is_changed(member.file)) return fail(Code::bad_input, name_changed(member.file));
  for (const auto& member : members)
    if (member.set != members.front().set)
      return fail(Code::bad_input, name_strangers(members.front().file, member.file));
  return {};
}

std::vector<std::string> find_strangers(const fs::path& file) {
  std::vector<std::string> out;
  const std::string set = set_in(file);
  if (set.empty()) return out;
  for (const auto& other : files_beside(file))
    if (const auto theirs = set_in(other); !theirs.empty() && theirs != set)
      out.push_back(name_strangers(file, other));
  return out;
}

std::vector<std::string> find_changed(const fs::path& file) {
  std::vector<std::string> out;
  const std::string set = set_in(file);
  if (set.empty()) return out;
  if (ending_of(file) == ".json" && is_changed(file)) out.push_back(name_changed(file));
  for (const auto& other : files_beside(file))
    if (set_in(other) == set && is_changed(other)) out.push_back(name_changed(other));
  return out;
}

}  // namespace kinemark::pipeline

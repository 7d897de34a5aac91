// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/matlab/internal/mat_parse.h"
#include "kinemark/io/matlab/internal/own_struct.h"
#include "kinemark/io/matlab/internal/plain_arrays.h"
#include "kinemark/io/matlab/internal/qtm_struct.h"
#include "kinemark/io/matlab/mat.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kNamesInMessage = 5;

bool is_version_7_3(std::string_view begin) { return begin.starts_with("MATLAB 7.3 MAT-file"); }

/// The version and the order of bytes at the end of the header.
bool has_version_5(std::string_view begin) {
  using namespace std::string_view_literals;
  if (begin.size() < internal::kMatHeaderBytes) return false;
  const auto end = begin.substr(124, 4);
  return end == "\0\1IM"sv || end == "\1\0MI"sv;
}

Result<data::Trial> read_variables(const std::vector<internal::MatArray>& variables, std::string_view unit) {
  std::vector<std::string> names;
  const internal::MatArray* found = nullptr;
  std::vector<std::string> others;
  for (const auto& variable : variables) {
    const bool is_recording = internal::is_own_struct(variable) || internal::is_qtm_struct(variable);
    if (is_recording && found) others.push_back(printable(variable.name, 63));
    if (is_recording && !found) found = &variable;
    if (!variable.name.empty()) names.push_back(printable(variable.name, 63));
  }
  if (found && !unit.empty())
    return fail(Code::usage,
                fmt::format("'{}' states the unit of its coordinates; one (--unit) is given only for "
                            "arrays that state none",
                            printable(found->name, 63)));
  if (found) {
    auto trial = internal::is_own_struct(*found) ? internal::read_own_struct(*found)
                                                 : internal::read_qtm_struct(*found);
    if (trial && !others.empty())
      trial->warnings.push_back(fmt::format("of several recordings '{}' is read; not read: {}",
                                            printable(found->name, 63), join_some(others, kNamesInMessage)));
    return trial;
  }
  const std::string there = fmt::format("holds {}{}", names.empty() ? "no variable" : "the variables ",
                                        join_some(names, kNamesInMessage));
  auto arrays = internal::plain_arrays(variables);
  if (arrays.empty())
    return fail(
        Code::not_supported,
        fmt::format("{}; expected a struct of kinemark, one that QTM exported, with Trajectories and "
                    "FrameRate, or arrays of numbers (tables and other objects of MATLAB are not read)",
                    there));
  auto trial = trial_of_arrays(std::move(arrays), unit);
  if (!trial)
    return fail(trial.error().code,
                fmt::format("{}, no struct of kinemark or QTM; as arrays: {}", there, trial.error().message));
  return trial;
}

}  // namespace

bool is_mat(std::string_view begin) { return is_version_7_3(begin) || has_version_5(begin); }

Result<data::Trial> parse_mat(std::span<const std::byte> bytes, std::string_view name,
                              std::string_view unit) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (is_version_7_3(text))
    return fail(
        Code::not_supported,
        fmt::format("{}: is a MAT file of version 7.3, which is not read; save it again in MATLAB with "
                    "save('FILE.mat', 'NAME', '-v7')",
                    name));
  if (!has_version_5(text))
    return fail(
        Code::bad_input,
        fmt::format("{}: has not the first 128 bytes of a MAT file of version 5 to 7; save it again in "
                    "MATLAB with save('FILE.mat', 'NAME', '-v7')",
                    name));
  const auto content = internal::parse_mat_variables(bytes);
  if (!content) return fail_at(name, content.error());
  auto trial = read_variables(content->variables, unit);
  if (!trial) return fail_at(name, {trial.error().code, printable_sentence(trial.error().message)});
  trial->source = name;
  trial->format = "MAT";
  if (auto s = trial->validate(); !s)
    return fail_at(name, {s.error().code, printable_sentence(s.error().message)});
  return trial;
}

Result<data::Trial> read_mat(const std::filesystem::path& path, std::string_view unit) {
  const auto bytes = read_text(path);
  if (!bytes) return std::unexpected(bytes.error());
  return parse_mat(std::as_bytes(std::span(*bytes)), path.string(), unit);
}

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The files of a result: written one after the other, seen together.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/table.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/staging.h"

namespace kinemark::pipeline {

/// A file of a result: what it will be called, and how it is written to another path before that.
struct ResultFile {
  std::filesystem::path target;  ///< what it will be called
  /// Called once with the path to write to, and the set that the file is to name (empty: none).
  std::function<Status(const std::filesystem::path& staged, const std::string& set)> write;
};

/// Text that is made when its turn comes. It names no set.
[[nodiscard]] ResultFile text_file(std::filesystem::path target, std::function<std::string()> make);
/// A TOML text, with its set as a comment.
[[nodiscard]] ResultFile toml_file(std::filesystem::path target, std::function<std::string()> make);
/// An object of JSON, made when its turn comes, with its set under "kinemark_set".
[[nodiscard]] ResultFile json_file(std::filesystem::path target,
                                   std::function<nlohmann::ordered_json()> make);
/// A table, made when its turn comes.
[[nodiscard]] ResultFile table_file(std::filesystem::path target, std::function<data::Table()> make);
/// Markers in the format of the ending, or an .osim. The object must live until the file is written.
[[nodiscard]] ResultFile marker_file(std::filesystem::path target, const data::Trial& trial);
/// An .osim. The object must live until the file is written.
[[nodiscard]] ResultFile model_file(std::filesystem::path target, const data::ModelDescription& model);
/// An .osim whose text is there already, with its set as a comment.
[[nodiscard]] ResultFile model_text_file(std::filesystem::path target, const std::string& text);

/// Write the files and let them appear together. On a failure, which names the target, none appears.
///
/// @param staging   made for all targets of the files; it may have more
/// @param progress  counts files; a caller that stops it ends with Code::cancelled and "WHAT was stopped"
/// @param set       that the files name (SetDigest); empty: they name none
/// @return          the targets that were written, in the order of the staging
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_results(Staging& staging,
                                                                       const std::vector<ResultFile>& files,
                                                                       const Progress& progress,
                                                                       std::string_view what,
                                                                       const std::string& set = {});

}  // namespace kinemark::pipeline

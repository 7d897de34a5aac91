// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Where a motion recording lies in a BIDS data set, by its path
/// TOP/sub-LABEL[/ses-LABEL]/motion/sub-LABEL[_ses-LABEL]_task-LABEL_tracksys-LABEL[_acq-LABEL][_run-INDEX]_motion.tsv
struct MotionName {
  std::filesystem::path top;     ///< of the data set; may be empty: the current folder
  std::filesystem::path folder;  ///< of the recording
  std::string stem;              ///< of its files, without "_motion.tsv"
  std::string task;              ///< label
  std::string tracksys;          ///< label of the system that tracked

  /// Path of a file of the recording: the stem, and "motion.json", "channels.tsv".
  [[nodiscard]] std::filesystem::path file(std::string_view ending) const;
};

/// Code::usage, saying the pattern, for any other path. Labels are letters and digits.
[[nodiscard]] Result<MotionName> parse_motion_name(const std::filesystem::path& path);

/// The path of the file that describes a recording's: of the same name, or, as BIDS has it, the one with most
/// of its entities in this folder or above it up to the top of the data set. Nothing when there is none.
/// @param path    of "..._motion.tsv"
/// @param ending  "motion.json" or "channels.tsv"
[[nodiscard]] std::optional<std::filesystem::path> find_sidecar(const std::filesystem::path& path,
                                                                std::string_view ending);

/// Whether a path ends in "_motion.tsv".
[[nodiscard]] bool is_motion_tsv(const std::filesystem::path& path);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/bids/motion_name.h"

// Motion-BIDS (BIDS 1.9): a table without a header, and files that say what it holds. docs/formats/bids.md
namespace kinemark::io {

/// Read the recording of a "..._motion.tsv": its columns as channels.tsv names them, rate and words for
/// missing values as motion.json does, each beside it or inherited from above. POS columns x, y, z of a
/// tracked point become a marker, other triples a channel; what is neither is left out with a warning.
/// Code::bad_input, with file and line, for tables that do not fit each other or no recording of that name;
/// Code::io when a file cannot be read. Memory: at most 16 times the text; of full tables about twice.
[[nodiscard]] Result<data::Trial> read_motion_bids(const std::filesystem::path& path);

/// The three texts of a recording, and how they are called in messages.
struct MotionTexts {
  std::string_view motion;                     ///< the table, without a header
  std::string_view channels;                   ///< what its columns are
  std::string_view json;                       ///< rate and words for missing values
  std::string motion_name = "motion.tsv";      ///< for messages
  std::string channels_name = "channels.tsv";  ///< for messages
  std::string json_name = "motion.json";       ///< for messages
};
/// The same from memory.
[[nodiscard]] Result<data::Trial> parse_motion_bids(const MotionTexts& texts);

/// A file of a recording.
struct MotionFile {
  std::filesystem::path path;                                    ///< where it belongs
  std::function<Status(const std::filesystem::path& to)> write;  ///< writes it to another path
};

/// The files that a recording becomes: "..._motion.tsv" first, then motion.json, channels.tsv and
/// channels.json, and dataset_description.json and README of the data set where `top` has none. The trial
/// must live until they are written. Code::bad_input: the trial is not valid, has no frames or markers, or a
/// name holds a tab or a line end.
[[nodiscard]] Result<std::vector<MotionFile>> motion_files(const MotionName& name, const data::Trial& trial);

}  // namespace kinemark::io

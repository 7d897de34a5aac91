// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Several files and folders where a command takes one file.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/pipeline/files/input_list.h"
#include "kinemark/pipeline/files/many.h"

namespace kinemark::cli {

/// More than one input, or a folder.
[[nodiscard]] bool are_many(const std::vector<std::filesystem::path>& given);

/// Inputs and output of a command that makes one file of one, or a folder of files of many.
struct ManyArguments {
  std::vector<std::filesystem::path> inputs;  ///< files and folders
  std::filesystem::path output;               ///< a file, or a folder
  std::string to;                             ///< ending of the files in the folder, ".trc"; empty: not given
  std::filesystem::path pages;                ///< as ManyJob
  int jobs = 1;                               ///< as ManyJob
  bool keep_going = false;                    ///< as ManyJob

  /// The last of the names is the output, and `to` gets its dot. Code::usage without an output, for a `to`
  /// without a folder, or one that is no format of markers. For positional arguments alone.
  [[nodiscard]] Status split_output();
  /// `to` gets its dot. Code::usage for one that is no format of markers.
  [[nodiscard]] Status check_format();
  /// Code::usage where an option of several recordings is given for this one.
  [[nodiscard]] Status check_single() const;
  /// Whether there are several inputs, or the output is a folder that is there or ends in a slash.
  [[nodiscard]] bool are_many() const;
};

/// Formats that markers are written in: "c3d, trc, ...".
[[nodiscard]] std::string written_formats();

/// IN, OUT and --to. @param in  what IN is, for the help
void add_in_and_out(CLI::App& command, ManyArguments& arguments, const char* in);

/// --jobs and --keep-going.
void add_many_options(CLI::App& command, ManyArguments& arguments);

/// Run the job for every recording, `ending` being the outputs' (empty: each its input's), and print the
/// table; the exit status. @param belongs  as ManyJob
[[nodiscard]] int run_each(const CommonOptions& common, const ManyArguments& arguments, std::string ending,
                           std::string belongs, decltype(pipeline::ManyJob::run_one) run_one);

}  // namespace kinemark::cli

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What was done in a step: a file beside its results, by which a run knows what need not be done again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/run/run_steps.h"

namespace kinemark::pipeline {

// Which files a command had to do with, by what it said and by what its results say.

/// A file and the checksum of its content.
using HashedFile = std::pair<std::string, std::string>;

/// The files of the lines "wrote FILE".
[[nodiscard]] std::vector<std::filesystem::path> written_files(const std::vector<std::string>& said);

/// The files that results name as what they were made from: "inputs" of a .json among them, with checksums
/// as they were then. Results that are no such JSON name none. @param base  folder from which paths count
[[nodiscard]] std::vector<HashedFile> named_inputs(const std::vector<std::filesystem::path>& results,
                                                   const std::filesystem::path& base);

/// What was done.
struct StepRecord {
  bool done = false;               ///< false: begun, and perhaps stopped half-way
  std::string version;             ///< of the program
  std::vector<std::string> words;  ///< of the command
  std::vector<HashedFile> inputs;  ///< those of the step as it began, then those that its results name
  std::vector<HashedFile>
      outputs;          ///< as they were when it was done; of one that began: those of the last time
  int exit_status = 0;  ///< 0, or 1: a quality gate was missed
  std::vector<std::string> said;  ///< lines of the command
};

/// What is to be done with a step.
enum class StepState : std::uint8_t {
  current,   ///< nothing: its results are those of these inputs and options
  due,       ///< it runs; what is there of its results was made by a run
  occupied,  ///< a file is in the way that no run made, or that was changed since
};

/// As found, and the sentence about a file that is in the way.
struct FoundState {
  StepState state = StepState::due;  ///< what is to be done
  std::string sentence;              ///< of occupied
  StepRecord record;                 ///< of current
};

/// Look at a step's record and files. Code::io for an input that cannot be read, Code::bad_input for a record
/// that is none. @param base  folder from which the step's paths count
[[nodiscard]] Result<FoundState> find_state(const RunStep& step, const std::filesystem::path& base);

/// Write that a step begins; its record replaces an older one. The record that mark_done() completes.
[[nodiscard]] Result<StepRecord> mark_begun(const RunStep& step, const std::filesystem::path& base);

/// Write that it is done, with all files that the command said it wrote. Those of the last time that it did
/// not write again are removed, unless they were changed. Code::bad_input, naming it, where an output is
/// missing.
[[nodiscard]] Status mark_done(const RunStep& step, const std::filesystem::path& base, StepRecord record);

/// A record as text.
[[nodiscard]] std::string record_text(const StepRecord& record);
/// The record of a text; Code::bad_input for one that is none. @param name  of the file, for the message
[[nodiscard]] Result<StepRecord> parse_record(const std::string& text, const std::string& name);

}  // namespace kinemark::pipeline

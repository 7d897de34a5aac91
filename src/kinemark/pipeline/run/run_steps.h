// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The commands that a run file asks for.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/run/run_file.h"

namespace kinemark::pipeline {

/// One command. Its paths count from the folder of the run file.
struct RunStep {
  std::string subject;                         ///< name
  std::string trial;                           ///< name of the recording; empty: of the subject as a whole
  std::string name;                            ///< of kSteps
  std::vector<std::string> words;              ///< as typed after the program's name, without --force
  std::vector<std::filesystem::path> inputs;   ///< files that it reads
  std::vector<std::filesystem::path> outputs;  ///< files that must be there when it is done
  std::filesystem::path record;                ///< of what was done
  std::vector<std::size_t> after;              ///< steps that come first
  std::vector<int> lines;                      ///< of the options, in the file; for messages
};

/// All steps, each behind those that it needs. Patterns are looked up on the disk. In the values of options
/// {trial} stands for the file of the recording and {subject} for the subject's name. Code::bad_input, naming
/// the place in the file, for a pattern that nothing fits, two recordings of one name, and a trial without a
/// model.
[[nodiscard]] Result<std::vector<RunStep>> plan_steps(const RunFile& file);

}  // namespace kinemark::pipeline

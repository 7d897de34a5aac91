// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The file that says what is done with the recordings of a study: docs/formats/run.md.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/settings_file.h"

namespace kinemark::pipeline {

/// Steps that a run file may name, in the order in which they are done; each is the command of that name.
inline constexpr std::array<std::string_view, 8> kSteps = {"joints", "scale", "reconstruct", "clean",
                                                           "ik",     "track", "analyze",     "report"};

/// Options of one step.
struct StepOptions {
  std::string step;           ///< of kSteps
  std::vector<Setting> list;  ///< as in a file of options
};

/// A recording.
struct RunTrial {
  std::string file;                  ///< as given; a pattern (walk*.c3d) stands for all that fit it
  std::vector<StepOptions> options;  ///< for it alone
  int line = 0;                      ///< in the file
};

/// A person or an animal.
struct RunSubject {
  std::string name;                  ///< of its folder
  std::string static_trial;          ///< for `scale`; may be empty
  std::string functional;            ///< motion for `joints` and `scale`; may be empty
  double mass_kg = 0.0;              ///< for `scale`; 0: the model's
  std::string session;               ///< folder whose trials are the subject's too; may be empty
  std::vector<RunTrial> trials;      ///< in the order of the file
  std::vector<StepOptions> options;  ///< for its trials
  int line = 0;                      ///< in the file
};

/// What a run file says. Paths are as given; they count from the folder of the file.
struct RunFile {
  std::filesystem::path path;        ///< of the file
  std::string output = "results";    ///< folder
  std::vector<std::string> steps;    ///< in the order of kSteps
  std::vector<StepOptions> options;  ///< for all subjects
  std::vector<RunSubject> subjects;  ///< in the order of the file

  [[nodiscard]] bool does(std::string_view step) const;  ///< is among the steps
};

/// Code::bad_input, naming file, place and what was expected: unknown keys and steps (with the nearest
/// names), options of a step that is not done, names that are no folder's or stand twice, a subject without
/// trials, and what needs the file of a step that is not given (`scale` without static trial and motion).
[[nodiscard]] Result<RunFile> read_run_file(const std::filesystem::path& path);
/// The same of a text. @param path  of the file, for messages and paths in it
[[nodiscard]] Result<RunFile> parse_run_file(std::string_view text, const std::filesystem::path& path);

}  // namespace kinemark::pipeline

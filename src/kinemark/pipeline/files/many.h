// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One job for each of many recordings, begun again where it was stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// How a recording fared.
enum class TrialStatus {
  good,         ///< done
  missed_gate,  ///< done; a quality gate was missed
  there,        ///< its output was there before
  outdated,     ///< its output was there before, but is older than the recording
  failed,       ///< no output
  not_begun,    ///< an earlier one had failed
};

/// "good", "missed a gate", "there already", "older than its input", "failed", "not begun"
[[nodiscard]] std::string_view to_string(TrialStatus status);

/// What `kinemark COMMAND FILES... FOLDER` is asked to do.
struct ManyJob : JobSettings {
  std::vector<std::filesystem::path> inputs;  ///< recordings
  std::filesystem::path folder;               ///< for the outputs; made when absent
  std::filesystem::path pages;  ///< where each job writes the page NAME.html as well; empty: none
  std::string ending;           ///< of the outputs, ".trc"; empty: each its input's
  int jobs = 1;                 ///< recordings at a time; 0: one for each core
  bool keep_going = false;      ///< the others are done when one has failed
  std::string belongs;          ///< what belongs to each OUT as well, "_report.json"; empty: nothing
  /// The job of one recording: input, output, page (empty: none), and settings to take over.
  std::function<Result<JobOutcome>(const std::filesystem::path& input, const std::filesystem::path& output,
                                   const std::filesystem::path& page, const JobSettings& settings)>
      run_one;
};

/// One recording.
struct TrialOutcome {
  std::filesystem::path input;                  ///< as given
  std::filesystem::path output;                 ///< folder / name of the input, with the ending
  TrialStatus status = TrialStatus::not_begun;  ///< how it fared
  std::string said;          ///< the failure, the gate that was missed, or the first warning
  std::size_t warnings = 0;  ///< how many there were
  double seconds = 0.0;      ///< wall time
  int exit_status = 0;       ///< of this one alone
};

/// How all of them fared, in the order of the inputs.
struct ManyOutcome {
  std::vector<TrialOutcome> trials;  ///< one an input

  /// The worst: a failure's, else 1 where a gate was missed or an output is older than its input, else 0.
  [[nodiscard]] int exit_status() const;
};

/// Runs the job for each input whose output is not there yet; with `force` for all. An output is there when
/// it exists, with its page and its report of the same set where they belong to it; what a killed run left of
/// a set is replaced. The number of recordings at a time changes no bit. Progress counts recordings.
///
/// Fails before anything is written: Code::usage for two inputs of one output name (case ignored), an output
/// that is an input; Code::io where the folder cannot be made.
[[nodiscard]] Result<ManyOutcome> run_many(const ManyJob& job);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Averages around events, from files to files: `kinemark measure --around`.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/neural.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/workflow/around/around.h"

namespace kinemark::pipeline {

/// What `kinemark measure --around` is asked to do.
struct AroundJob : JobSettings, RecordingOptions, workflow::AroundChoice {
  std::filesystem::path input;   ///< recording of markers, or a motion (.mot, .sto)
  std::filesystem::path spikes;  ///< .nwb with units on the same clock; empty: the recording itself
  std::filesystem::path output;  ///< .csv, .json or .nwb; empty: none
  std::int64_t refits = 99;      ///< behind the times of movement starts
  double noise_sd_m = 0.0;       ///< of markers, per axis; 0: found from the samples
};

/// Averages; warnings are what is left out.
struct AroundOutcome : JobOutcome {
  std::vector<data::InputFile> inputs;        ///< that were read
  std::vector<analysis::AroundCurve> curves;  ///< as workflow::AroundFound
};

/// The files that the job reads, as far as it names them.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const AroundJob& job);

/// Read, average, write. Speeds are those of the smoother that `kinemark clean` uses by itself. Code::usage
/// as workflow::around(), for another ending of the output, and for movement starts of a motion;
/// Code::bad_input as the readers and workflow::around(). Progress counts nothing.
[[nodiscard]] Result<AroundOutcome> run_around(const AroundJob& job);

/// "inputs", "around" (around_json()), "written", "warnings".
[[nodiscard]] nlohmann::ordered_json around_outcome_json(const AroundOutcome& outcome, const AroundJob& job);

}  // namespace kinemark::pipeline

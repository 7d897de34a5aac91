// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments and joint angles of a recording by a definition: files in, files out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/measures/gait_drawing.h"
#include "kinemark/workflow/segments/segments.h"

namespace kinemark::pipeline {

/// What `kinemark segments` is asked to do. Paths that are empty are not used. Of the options of a
/// recording the rate, the journals beside, the axes and what becomes of doubtful samples (dropped unless
/// they are to be kept) count for the static trial and the others too; up is found where nobody says it, else
/// z.
struct SegmentsJob : JobSettings, RecordingOptions, GaitOutputs {
  std::filesystem::path input;         ///< marker file
  std::string definition;              ///< name of a shipped one, or a .toml
  std::filesystem::path static_trial;  ///< marker file; the recording itself: it is its own static trial
  std::vector<std::string> trials;     ///< NAME=FILE, trials in which landmarks were shown
  std::filesystem::path vsk;           ///< measures of the subject, .vsk or .mp
  std::vector<std::string> subject;    ///< NAME=VALUE or NAME=VALUE+-SD, mm, deg, kg
  std::filesystem::path
      forces;               ///< io::read_external_forces() instead of the recording's plates; empty: these
  double noise_sd_m = 0.0;  ///< per axis; 0: of the file, else found
  std::filesystem::path output;  ///< folder; empty: nothing is written
  std::int64_t refits = 99;      ///< behind deviations of loads and intervals of walking; 0: none
  double level = 0.95;           ///< of these intervals
};

/// Warnings: those of the readers, then what the verb has to say. Gate: static_trial.
struct SegmentsOutcome : JobOutcome, workflow::SegmentsFound {
  std::vector<data::InputFile> inputs;  ///< all that were read
  std::string title;                    ///< of the definition
  std::optional<analysis::Gait> gait;   ///< walking, where its cycles were asked for and are there
};

/// Read, compute (workflow::segments()), write into the folder `output`: angles.mot and angles_sd.sto
/// (degrees, metres), angles.csv with states, centres.csv with covariances, segments.c3d (the recording with
/// angles, loads and centres) and segments.json; loads.sto, loads_sd.sto and loads.csv where there are loads.
/// Progress counts files. Figures, page, events and cycles that are asked for need walking in the recording:
/// without it they are not there, which is a warning, or Code::bad_input where nothing else is written.
///
/// Code::usage for names and numbers that make no sense; Code::bad_input as the readers and
/// workflow::segments(); Code::io as Staging.
[[nodiscard]] Result<SegmentsOutcome> run_segments(const SegmentsJob& job);

/// "0.02 to 0.3 mm a sample, median 0.1": what markers' samples err by, as deviations have it. Empty: it was
/// stated, or the markers carry covariances.
[[nodiscard]] std::string sample_noise(const analysis::SegmentMotion& motion);

/// Measures that are assumed and have a deviation, with it: "MarkerDiameter 14 mm (SD 2)". Empty: none.
[[nodiscard]] std::string assumed_measures(const analysis::SegmentMotion& motion);

/// "definition", "inputs", "parameters", "noise" (noises_json(), where it was found), "comparison" (where the
/// file holds outputs), "angles", "loads", "steps" (on plates), "cross_talk" (a list of "name",
/// "correlation", "varus_deg", "flexion_deg", "suspicious", "sentence"), "static_trial", "written",
/// "warnings".
[[nodiscard]] nlohmann::ordered_json segments_outcome_json(const SegmentsOutcome& outcome);

}  // namespace kinemark::pipeline

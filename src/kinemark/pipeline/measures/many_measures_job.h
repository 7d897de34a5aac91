// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of many recordings in one table.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/many.h"
#include "kinemark/pipeline/measures/measured_recording.h"
#include "kinemark/pipeline/measures/measures_job.h"

namespace kinemark::pipeline {

/// What `kinemark measure`, `gait`, `emg` or `analyze` of several recordings is asked to do. Of the job of
/// one recording the input is not used; outputs are one table each over all recordings.
struct ManyMeasuresJob : MeasuresJob {
  std::vector<std::filesystem::path> inputs;  ///< files and folders, as list_recordings()
  int jobs = 1;                               ///< recordings at a time; 0: one for each core
};

/// What one recording gives to the tables.
struct RecordingRows {
  RecordingName name;                ///< of its rows
  MeasuresOutcome outcome;           ///< measures and warnings
  std::vector<EventRow> events;      ///< where they are written
  std::vector<RegionCurves> cycles;  ///< where they are written
};

/// All of them, in the order of the inputs.
struct ManyMeasuresOutcome : ManyOutcome {
  std::vector<RecordingRows> recordings;       ///< those that could be measured
  std::vector<std::string> notes;              ///< what was passed over, a sentence each
  std::vector<std::filesystem::path> written;  ///< tables that are there now
};

/// Measure each recording as run_measures() does, and write one table of measures, of events and of cycles:
/// the lines of each recording are those of its own run. A recording that fails is a trial that failed; the
/// others are measured, and where one of them could be, the tables are written. Without a participants' table
/// the participants.tsv of the folder that is given is joined, if there is one. Progress counts recordings.
///
/// Fails before anything is read: Code::usage without a table to write or JSON to print, for what is made of
/// one recording alone (figures, a page, a .c3d, envelopes, angles, a named journal), and as
/// list_recordings(), read_participants(), asked_measures() and Staging.
[[nodiscard]] Result<ManyMeasuresOutcome> run_many_measures(const ManyMeasuresJob& job);

/// "recordings" (each as measures_outcome_json() without "written", with participant, session and trial),
/// "failed" (path and error), "written", "notes".
[[nodiscard]] nlohmann::ordered_json many_measures_json(const ManyMeasuresOutcome& outcome);

}  // namespace kinemark::pipeline

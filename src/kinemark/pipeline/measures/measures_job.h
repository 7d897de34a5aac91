// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of the paths of a recording's markers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/measures/emg_request.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/workflow/measures/measure.h"

namespace kinemark::pipeline {

/// What `kinemark measure`, `gait`, `emg` and `analyze` are asked to do with a recording of markers: ids of
/// paths, of walking ("gait": all of these), of plates ("plates") and of EMG ("emg"), regions beside those of
/// the journal; figures and page are of paths, too. Paths that are empty are not used. Doubtful samples are
/// dropped unless they are to be kept.
struct MeasuresJob : JobSettings, RecordingOptions, workflow::MeasureChoice, GaitOutputs {
  std::filesystem::path input;   ///< marker file
  std::filesystem::path output;  ///< .csv, .json or .nwb
  std::filesystem::path
      forces;          ///< io::read_external_forces() instead of the recording's plates; empty: these
  std::string trials;  ///< trial_spans(); empty: those of the file where no other span is asked for of paths
  workflow::MeasuresOf of = workflow::MeasuresOf::everything;  ///< measures of others are refused
  double noise_sd_m = 0.0;                                     ///< per axis; 0: found from the samples
  EmgRequest emg;                                              ///< electromyograms
  std::filesystem::path participants_file;           ///< table to join to the rows, as read_participants()
  std::shared_ptr<const Participants> participants;  ///< the same, read; null: run_measures() reads it
};

/// Warnings: what was left out, and markers that could not be measured.
struct MeasuresOutcome : JobOutcome, workflow::MeasuresFound {
  data::InputFile input;                ///< the recording
  std::vector<data::InputFile> beside;  ///< what was read with it: its journal, forces
  SpanLabels spans;                     ///< conditions of the trials that are measured
};

/// The files that the job reads, as far as it names them. Names of no file may be among them.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const MeasuresJob& job);

/// Read, screen, measure, write. Walking is measured where it is asked for, and, without measures that are
/// asked for, where feet that step are found. Samples that the recorder made, that were filled or that
/// screening rejects are not measured; nothing is written where nothing can be measured. Progress counts
/// nothing.
///
/// Code::usage as analysis::PathMeasureOptions::check(), workflow::parse_region(), parse_figure_formats() and
/// for another ending than .csv, .json and .nwb; Code::bad_input as the readers, take_selection(),
/// workflow::regions_between() and analysis::measure_paths(), and where no marker can be measured.
[[nodiscard]] Result<MeasuresOutcome> run_measures(const MeasuresJob& job);

/// Code::usage for a table of measures of another ending than .csv, .json and .nwb.
[[nodiscard]] Status check_measures_output(const std::filesystem::path& output);

/// The recording and what was read with it.
[[nodiscard]] std::vector<data::InputFile> inputs_of(const MeasuresOutcome& outcome);

/// The commands that show what was measured, for a sentence: "'kinemark gait' (feet and force plates) and
/// 'kinemark measure' (paths of markers)". Empty: nothing was.
[[nodiscard]] std::string commands_for(const MeasuresOutcome& outcome);

/// "input", "measures" (measures_json()), "trials" (region and conditions, where trials are measured), "gait"
/// (gait_json(), where there is walking), "rhythms" (rhythms_json(), where movements of markers are looked
/// at), "noise" (noises_json(), of markers), "written", "warnings".
[[nodiscard]] nlohmann::ordered_json measures_outcome_json(const MeasuresOutcome& outcome);

}  // namespace kinemark::pipeline

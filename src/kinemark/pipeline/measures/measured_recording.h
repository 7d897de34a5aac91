// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a job asks, sorted once before any recording is read; one recording, read and measured. Nothing is
// written yet.
#pragma once

#include <optional>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/path/path_curves.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {

/// Options of the job, sorted: files of roles and of maxima are read. Code::usage for a measure that does not
/// exist, with the nearest names, for one of another command, and as gait_options() and
/// workflow::asked_measures(); else as the readers.
[[nodiscard]] Result<workflow::AskedMeasures> asked_measures(const MeasuresJob& job);

/// All that a recording gives.
struct MeasuredRecording {
  RecordingName name;                        ///< of its rows
  MeasuresOutcome outcome;                   ///< measures and warnings; nothing is written
  Recording recording;                       ///< as it was measured
  std::optional<data::Trial> recorded;       ///< as it was read, where a recording with its events is written
  std::vector<analysis::PathCurves> curves;  ///< for figures, where they are asked for
  std::vector<EventRow> events;              ///< of feet, or of the markers' own movements
  std::vector<RegionCurves> cycles;          ///< over strides or repetitions, where they are written
};

/// Read, screen, measure. Files that the job writes are looked at for what they need alone. Errors as
/// run_measures().
/// @param asked  asked_measures() of the job
[[nodiscard]] Result<MeasuredRecording> measure_recording(const MeasuresJob& job,
                                                          const workflow::AskedMeasures& asked);

}  // namespace kinemark::pipeline

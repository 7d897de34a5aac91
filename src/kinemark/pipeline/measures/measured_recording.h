// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One recording, read and measured; nothing is written yet.
#pragma once

#include <optional>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/gait_cycles.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/path/path_curves.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {

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
/// @param options  measure_options() of the job
[[nodiscard]] Result<MeasuredRecording> measure_recording(const MeasuresJob& job,
                                                          const workflow::MeasureOptions& options);

}  // namespace kinemark::pipeline

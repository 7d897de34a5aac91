// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which of the measures that are asked for are of paths, and which of walking.
#pragma once

#include <optional>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/path/path_measures.h"

namespace kinemark::pipeline {

/// What a job asks of paths and of walking.
struct AskedMeasures {
  analysis::PathMeasureOptions path;     ///< without regions
  analysis::GaitOptions gait;            ///< without regions
  analysis::ForceMeasureOptions plates;  ///< without regions and events
  analysis::EmgOptions emg;              ///< without stretches
  bool paths = true;                     ///< whether paths are measured
  bool walking = true;                   ///< whether walking is measured, where there is any
  bool by_name = false;                  ///< walking is asked for: what it lacks has to be said
  bool forces = true;                    ///< whether plates are measured, where there are any
  bool forces_by_name = false;           ///< plates are asked for
  bool muscles = true;                   ///< whether EMG are measured, where there are any
  bool muscles_by_name = false;          ///< EMG are asked for
};

/// What a measure is of, by its id or the word for all of a kind ("gait", "plates", "emg"); nothing for one
/// that is of a motion or does not exist.
[[nodiscard]] std::optional<MeasuresOf> measures_of(const std::string& id);

/// Code::usage for a measure that does not exist, with the nearest names, and as gait_options() and
/// analysis::PathMeasureOptions::check().
[[nodiscard]] Result<AskedMeasures> asked_measures(const MeasuresJob& job);

}  // namespace kinemark::pipeline

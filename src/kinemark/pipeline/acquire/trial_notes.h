// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/acquire/recorder.h"

namespace kinemark::pipeline {

/// One thing to know of a trial.
struct TrialNote {
  std::string text;  ///< a sentence; where something is wrong, with what to do
  bool good = true;  ///< nothing is wrong with it
};

/// What there is to know of a trial before the next one, one sentence each: noise of LEDs that stood still,
/// what is missing and who lost it, saturation, the device's clock.
/// @param layout  names, as recorded
[[nodiscard]] std::vector<TrialNote> describe_trial(const Recorded& recorded, const data::Counts& layout);

/// "frames_missing": no frame was lost.
[[nodiscard]] data::Gate missing_gate(const RecorderProgress& progress);

}  // namespace kinemark::pipeline

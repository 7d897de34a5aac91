// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// Whether an LED gave no light at a camera: its channels together are less than 3 % of the codes above the
/// dark level. @param at  its place in Recorded::lit
[[nodiscard]] bool is_dark(const Recorded& recorded, const data::Counts& layout, std::size_t at);

/// What there is to know of a trial before the next one, one sentence each: noise of LEDs that stood still,
/// what is missing and who lost it, LEDs that are dark or saturate a camera, the device's clock.
/// @param layout  names, as recorded
[[nodiscard]] std::vector<TrialNote> describe_trial(const Recorded& recorded, const data::Counts& layout);

/// "frames_missing": every frame is kept.
[[nodiscard]] data::Gate missing_gate(const RecorderProgress& progress);

}  // namespace kinemark::pipeline

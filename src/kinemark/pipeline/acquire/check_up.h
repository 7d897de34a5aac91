// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/acquire/recorder.h"
#include "kinemark/pipeline/acquire/trial_notes.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// What a device shows in some seconds that nobody keeps, a line each: its rate and the scatter of arrivals,
/// frames that are missing, the dark level of each camera, noise of each channel, channels that follow no
/// light, each LED at each camera. Where something is wrong, the line says what to do.
///
/// Bounds: rate within 1,000 millionths of what was granted, or 4 SD; dark level 1 count to a tenth of the
/// codes; noise of a channel (least over the LEDs, so that movement is not taken for it) at most three times
/// the median of all plus half a count; the channels of an LED together at least 3 % of the codes above the
/// dark level, none of them at the highest code.
/// @param recorded  without a file
[[nodiscard]] std::vector<TrialNote> check_up(const Recorded& recorded, const stream::GrantedPlan& granted);

/// "check_up": every line is good.
[[nodiscard]] data::Gate check_up_gate(const std::vector<TrialNote>& lines);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint angles over the cycles that a recording's events mark.
#pragma once

#include <span>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/report/cycle_overlay.h"

namespace kinemark::pipeline::internal {

/// The coordinates that move over each cycle from strike to strike; where a name ends in `_l` or `_r` over
/// those of that foot, else over those of both. Values of undetermined coordinates are left out.
/// @param events     of the recording; those that mark no foot strike are passed over
/// @param recording  its clock
/// @return  empty where no foot strikes twice
[[nodiscard]] std::vector<report::CycleOverlay> cycle_overlays(std::span<const data::Event> events,
                                                               const TimeBase& recording,
                                                               const data::JointMotion& motion);

/// The same cycles in time alone.
[[nodiscard]] std::vector<report::CycleSpan> cycle_spans(std::span<const data::Event> events,
                                                         const TimeBase& recording);

}  // namespace kinemark::pipeline::internal

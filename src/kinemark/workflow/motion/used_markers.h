// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers as a motion was solved from them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::workflow {

/// Some markers of a recording on some of its frames, with positions, states and what is known of their
/// filters.
///
/// @param from         M indices into the recorded markers
/// @param names        M names that they get
/// @param first_frame  of the recording; time.frames frames from there must exist
/// @param time         clock of the result
[[nodiscard]] data::Trajectories select_markers(const data::Trajectories& recorded,
                                                std::span<const std::int64_t> from,
                                                std::vector<std::string> names, std::int64_t first_frame,
                                                const TimeBase& time);

/// The used markers on the frames that were solved, under the model's names: labels exchanged back, and
/// without what was left out.
[[nodiscard]] data::Trajectories solved_markers(const data::Trajectories& recorded,
                                                const data::MarkerFit& fit, const data::JointMotion& motion);

/// Exchange the samples of every two markers that carry each other's labels in the frames of these findings.
void exchange_as_found(const data::MarkerFit& fit, data::Trajectories& markers);

}  // namespace kinemark::workflow

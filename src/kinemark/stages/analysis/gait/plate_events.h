// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Foot strike and toe-off from force plates, each given to the foot that stood there.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

/// What plates saw.
struct PlateEvents {
  std::vector<data::GaitEvent> events;  ///< by plate and time
  std::vector<std::string> notes;       ///< contacts that were not used, and why; one sentence each
};

/// Events of clean contacts: one foot alone on the plate, wholly, from landing to leaving.
///
/// A contact begins above 20 N, or five times the noise of the unloaded plate if that is more, and has ended
/// below half of it. Its instants are those at which the load, linear between frames, passes the former.
/// Their SD is a fifth of a frame, 2 ms and the noise over the slope, together.
///
/// @param plates   vertical forces that were not cut off at a threshold (contact_force_n 0), recording's
///                 clock and axes; whether a foot stands wholly on one without corners is not asked
/// @param upright  rotation to z up, GaitSmoother::upright()
[[nodiscard]] PlateEvents find_plate_events(const data::Wrenches& plates, const GaitPaths& paths,
                                            const Eigen::Matrix3d& upright);

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Foot strikes and leavings from the analog samples of force plates, as a truth for events of markers.
#pragma once

#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::testing_support {

/// Contacts of one foot alone and wholly on a plate: 20 N (3 % of the greatest load, where that is no
/// body's), lasting 0.08 s, a third of the greatest load. Where the load rises from 20 to 50 N in more than 4
/// ms, a filter went over it: the tangent through 8 and 20 % of the greatest load, back to zero, tells the
/// instant. The foot is that which moves less in the middle half of the contact.
/// @param upright  rotation to z up
[[nodiscard]] std::vector<data::GaitEvent> plate_truth(const data::Trial& trial,
                                                       const analysis::GaitPaths& paths,
                                                       const analysis::Steps& steps,
                                                       const Eigen::Matrix3d& upright);

}  // namespace kinemark::testing_support

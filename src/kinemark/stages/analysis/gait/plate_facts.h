// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Forces of plates against the feet on them and the body's mass.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

/// Mass that one step bears, kg: its vertical impulse over half a stride and gravity. Steps of one foot alone
/// and wholly on a plate; a contact begins at 3 % of the largest load of its plate, so that the unit of the
/// force does not matter.
/// @param plates    not cut off at a threshold (contact_force_n 0), on the recording's clock
/// @param stride_s  of both feet; NaN: no gait, and no step
[[nodiscard]] std::vector<double> borne_masses(const data::Wrenches& plates, const GaitPaths& paths,
                                               const Eigen::Matrix3d& upright, double stride_s);

/// Contradictions between plates, feet and mass, a sentence each: a plate none of whose loads is under a
/// foot, the nearer one 0.3 m away or more; steps that bear less than 0.6 or more than 1.6 times the stated
/// mass, or no person's: below 2 or above 400 kg.
/// @param mass_kg  of the body as somebody states it; NaN: nobody does
[[nodiscard]] std::vector<std::string> contradicted_plates(const data::Wrenches& plates,
                                                           const GaitPaths& paths,
                                                           const Eigen::Matrix3d& upright, double stride_s,
                                                           double mass_kg = kNaN);

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::motion {

/// Distribute a body mass over the segments by Dempster's fractions as tabulated by Winter (2009,
/// "Biomechanics and Motor Control of Human Movement", table 4.1): pelvis 0.142, trunk 0.355, head 0.081, per
/// side upper arm 0.028, forearm 0.016, hand 0.006, thigh 0.100, shank 0.0465, foot 0.0145.
///
/// The share of a segment that the model lacks goes to its neighbour towards the trunk. Bodies of one segment
/// keep their ratio; inertias change with the mass. Mass centres of upper arm, thigh and shank go to 0.436,
/// 0.433 and 0.433 of the way from the joint above to the joint below. Bodies of other names keep their mass,
/// which is taken from mass_kg. Fails without pelvis and trunk, or when nothing is left to distribute.
[[nodiscard]] Status distribute_mass(data::ModelDescription& model, double mass_kg);

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Movements as curves over time.
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/table.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/around/around.h"

namespace kinemark::workflow {

/// x, y, z of each marker at the true times of its samples, and its speed where there are velocities; NaN
/// where a sample is missing. Points without any sample are left out.
[[nodiscard]] std::vector<analysis::SampledCurve> curves_of(const data::Trajectories& markers,
                                                            const data::Derivatives* rates = nullptr);

/// Each column of a motion: "angle" in rad; lengths ("position", m) of columns named _tx, _ty, _tz.
/// @param degrees  rotations of the table are in degrees
[[nodiscard]] std::vector<analysis::SampledCurve> curves_of(const data::Table& motion, bool degrees);

/// From the first to the last sample of all curves.
[[nodiscard]] analysis::ObservedSpan span_of(const std::vector<analysis::SampledCurve>& curves);

}  // namespace kinemark::workflow

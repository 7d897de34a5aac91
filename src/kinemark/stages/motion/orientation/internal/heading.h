// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/orientations.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/orientation/internal/sensor_placement.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::motion::internal {

/// The turn of the sensors' world about the vertical, and one standard deviation.
struct Heading {
  double rad = 0.0;
  double sd_rad = 0.0;
};

/// The heading of least cost: one in 15 deg is tried, the valleys are refined. The standard deviation follows
/// from the curvature. Code::bad_input where another valley is as good within 3 standard deviations, or the
/// standard deviation is above 10 deg.
/// @param cost            sum of squares, by heading in rad; infinite where nothing is known
/// @param freedom         numbers that the cost is the sum of, less those that are fitted
/// @param least_variance  of one of these numbers
[[nodiscard]] Result<Heading> choose_heading(const std::function<double(double)>& cost, double freedom,
                                             double least_variance);

/// The heading under which the joints explain the motion best, in 24 frames spread over the range: axes of
/// hinges and ranges of coordinates, clamped or not, tell it. One in 15 deg is tried, the best ones are
/// refined. Code::bad_input where another one explains it nearly as well (3 standard deviations), or the
/// standard deviation is above 10 deg.
/// @param frames  that are solved, of the recording
[[nodiscard]] Result<Heading> estimate_heading(const model::Model& model, const data::Orientations& recording,
                                               const PosedSensors& posed,
                                               const std::vector<std::int64_t>& frames,
                                               const OrientationOptions& options);

/// Angles of these frames under a heading, by the model without lengths; markers are the tips of the sensors'
/// axes, three a sensor, where it is seen at all.
[[nodiscard]] Result<IkResult> solve_turned(const data::ModelDescription& model,
                                            const data::Orientations& recording, const PosedSensors& posed,
                                            const std::vector<std::int64_t>& frames, double heading_rad,
                                            const IkOptions& options, const Progress& progress = {});

}  // namespace kinemark::motion::internal

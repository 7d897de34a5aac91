// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "kinemark/core/time_base.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/ik_report.h"

namespace kinemark::report::internal {

/// Heading, noise, pose and a row for each sensor, angles in degrees: IkSensors of docs/formats/pages.md.
[[nodiscard]] nlohmann::ordered_json sensors_json(const ReportSensors& sensors, const TimeBase& time);

/// The angle of one sensor in one frame, deg; NaN: not used.
[[nodiscard]] double sensor_error_deg(const ReportSensors& sensors, std::int64_t frame, std::int64_t sensor);

/// RMS of these angles in one frame, deg; NaN: no sensor was used.
[[nodiscard]] double sensor_rms_deg(const ReportSensors& sensors, std::int64_t frame);

/// Sensors as points for the space view: in the middle of the bodies that carry them, m. Those whose body is
/// not drawn are left out.
[[nodiscard]] data::Trajectories sensor_points(const ReportSensors& sensors, const SceneBodies& bodies,
                                               const TimeBase& time);

}  // namespace kinemark::report::internal

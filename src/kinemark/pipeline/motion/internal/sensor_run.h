// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The steps of a run with inertial sensors that do not depend on whether there are markers beside them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/data/run_record.h"
#include "kinemark/data/table.h"
#include "kinemark/pipeline/motion/sensor_settings.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/motion/ik.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::pipeline::internal {

/// Take the vertical from the option of that name. Code::usage where it is no axis.
[[nodiscard]] Status check_up(SensorSettings& settings, const char* option);

/// Recording and pose, with the frames that the model has for the sensors where neither a pose nor a body is
/// given. The files go into `inputs`, what is irregular into `warnings`.
[[nodiscard]] Result<workflow::SensorInputs> read_sensors(const SensorSettings& settings,
                                                          const std::filesystem::path& model_file,
                                                          const model::Model& model,
                                                          std::vector<data::InputFile>& inputs,
                                                          std::vector<std::string>& warnings);

/// Sensors and samples left out, noise that is not known; gates on the RMS angle and on the pose.
/// @param beside_markers  only then may a recording have no pose at all
[[nodiscard]] workflow::Remarks sensor_remarks(const motion::OrientationFit& fit,
                                               const SensorSettings& settings, bool error_bars,
                                               bool beside_markers);

/// Heading, noise and places of the sensors as names and values, for the record of a run.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> sensor_facts(const motion::OrientationFit& fit,
                                                                            const SensorSettings& settings);

/// Angle between measured and model, degrees, a column a sensor.
[[nodiscard]] data::Table orientation_errors_table(const TimeBase& time, const motion::OrientationFit& fit,
                                                   const Array<double>& error_rad);

/// "sensors", what was left out of them, "heading" and the numbers of the fit, in degrees.
[[nodiscard]] nlohmann::ordered_json sensors_json(const motion::OrientationFit& fit);

/// What a page shows of the sensors. @param error_rad  F x S
[[nodiscard]] report::ReportSensors page_sensors(const TimeBase& time, const motion::OrientationFit& fit,
                                                 const Array<double>& error_rad);

}  // namespace kinemark::pipeline::internal

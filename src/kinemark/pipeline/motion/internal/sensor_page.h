// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/orientation_job.h"

namespace kinemark::pipeline::internal {

/// HTML of joint angles from sensors alone: angles with their bands, how far each sensor is from the model,
/// how they were placed, the heading, and the model's bodies in space.
[[nodiscard]] Result<std::string> sensor_page(const OrientationJob& job, const model::Model& model,
                                              const OrientationOutcome& outcome);

}  // namespace kinemark::pipeline::internal

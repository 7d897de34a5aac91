// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/ik_job.h"

namespace kinemark::pipeline {

/// Fill what the job leaves open (files, time range) from its OpenSim setup file, if it has one.
[[nodiscard]] Status apply_setup(IkJob& job);

/// Add the marker weights and coordinate tasks of the setup and task files, and widen the setup's time range
/// to the frames nearest to its ends, as OpenSim does. Weights already in the job take precedence. A manual
/// value is in radians or metres, as OpenSim takes it; from_file values are read from the coordinate file, in
/// degrees where that says so, and interpolated linearly at the recording's times.
[[nodiscard]] Status apply_tasks(IkJob& job, const model::Model& model, const data::Trajectories& markers);

}  // namespace kinemark::pipeline

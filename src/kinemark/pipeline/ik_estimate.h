// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What `kinemark ik` computes: coordinates by the estimator that the job names, torques when asked.
#pragma once

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/table.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/ik_job.h"

namespace kinemark::pipeline {

/// Least squares or the whole-trajectory smoother, told in the terms of the former; with torques (and, for
/// least squares, estimated rates) in the motion when the job asks for them.
[[nodiscard]] Result<motion::IkResult> estimate_motion(const IkJob& job, const model::Model& model,
                                                       const data::Trajectories& markers,
                                                       const Progress& progress);

/// Generalised forces, one column per coordinate ("knee_moment" in N m, "pelvis_tx_force" in N), and one
/// standard deviation of each.
[[nodiscard]] data::Table torques_table(const data::JointMotion& motion);
[[nodiscard]] data::Table torque_deviations_table(const data::JointMotion& motion);

}  // namespace kinemark::pipeline

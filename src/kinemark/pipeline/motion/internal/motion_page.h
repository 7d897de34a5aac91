// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page of a motion, however it was solved.
#pragma once

#include <string>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::pipeline::internal {

/// Where the bodies of a model are in a motion of it. A body ends where the bodies that it carries begin (the
/// middle of them), one that carries none as far beyond its mass centre as that lies from its origin. Bodies
/// without mass or length are left out, unless they have a mesh.
[[nodiscard]] report::SceneBodies body_positions(const model::Model& model, const data::JointMotion& motion,
                                                 const ModelMeshes& meshes = {});

/// HTML with the model's bodies in space, as the meshes that its file names where they are found, and over
/// the cycles that the recording's events mark.
/// @param markers    on the motion's clock; nullptr: not known
/// @param recording  what was solved
/// @param sensors    beside the markers; nullptr: none
[[nodiscard]] std::string motion_page(const MotionJob& job, const model::Model& model,
                                      const report::IkSummary& summary, const data::JointMotion& motion,
                                      const data::Trajectories* markers, const data::Trial& recording,
                                      const report::ReportSensors* sensors = nullptr);

}  // namespace kinemark::pipeline::internal

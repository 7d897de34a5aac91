// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "kinemark/io/input/recording_input.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/prepare/vertical.h"

#include "kinemark/pipeline/motion/internal/body_positions.h"
#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"

namespace kinemark::pipeline::internal {

std::string motion_page(const MotionJob& job, const model::Model& model, const report::IkSummary& summary,
                        const data::JointMotion& motion, const data::Trajectories* markers,
                        const data::Trial& recording, const report::ReportSensors* sensors) {
  const auto bodies =
      body_positions(model, motion, read_model_meshes(job.model, model.description(), job.geometry));
  return report::report_html({.summary = summary,
                              .motion = &motion,
                              .markers = markers,
                              .up = workflow::up_of(model),
                              .sensors = sensors,
                              .bodies = &bodies,
                              .cycles = cycle_overlays(recording.events, recording.markers.time, motion)});
}

}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/vertical.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"

#include "kinemark/pipeline/motion/internal/body_positions.h"
#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"

namespace kinemark::pipeline::internal {

data::Trajectories solved_markers(const data::Trajectories& recorded, const data::MarkerFit& fit,
                                  const data::JointMotion& motion) {
  std::vector<std::string> names;
  std::vector<std::int64_t> from;
  for (const auto& marker : fit.markers) {
    names.push_back(marker.name);
    from.push_back(recorded.find(marker.name_in_data));
  }
  auto markers = select_markers(recorded, from, std::move(names), fit.first_frame, motion.time);
  for (std::size_t i = 0; i < motion.marker_state.size(); ++i)
    if (motion.marker_state[i] == data::SampleState::rejected) {
      const auto M = static_cast<std::size_t>(markers.markers());
      markers.set_missing(static_cast<std::int64_t>(i / M), static_cast<std::int64_t>(i % M),
                          data::SampleState::rejected);
    }
  return markers;
}

std::string motion_page(const MotionJob& job, const model::Model& model, const report::IkSummary& summary,
                        const data::JointMotion& motion, const data::Trajectories* markers,
                        const data::Trial& recording) {
  const auto bodies =
      body_positions(model, motion, read_model_meshes(job.model, model.description(), job.geometry));
  return report::report_html({.summary = summary,
                              .motion = &motion,
                              .markers = markers,
                              .up = up_of(model),
                              .bodies = &bodies,
                              .cycles = cycle_overlays(recording.events, recording.markers.time, motion)});
}

}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/prepare/vertical.h"

#include "kinemark/pipeline/motion/internal/body_positions.h"
#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"

namespace kinemark::pipeline::internal {

void exchange_as_found(const data::MarkerFit& fit, data::Trajectories& markers) {
  const auto exchange = [&](std::int64_t f, std::int64_t one, std::int64_t other) {
    const Eigen::Vector3d x = markers.x(f, one);
    markers.x(f, one) = markers.x(f, other);
    markers.x(f, other) = x;
    std::swap(markers.state[markers.index(f, one)], markers.state[markers.index(f, other)]);
  };
  for (const auto& finding : fit.findings) {
    if (finding.kind != data::FindingKind::label_swap) continue;
    const auto one = markers.find(finding.subject), other = markers.find(finding.partner);
    if (one < 0 || other < 0 || finding.last_frame >= markers.frames()) continue;
    for (const auto f : finding.frames) exchange(f, one, other);
    if (finding.frames.empty())
      for (auto f = finding.first_frame; f >= 0 && f <= finding.last_frame; ++f) exchange(f, one, other);
  }
}

data::Trajectories solved_markers(const data::Trajectories& recorded, const data::MarkerFit& fit,
                                  const data::JointMotion& motion) {
  std::vector<std::string> names;
  std::vector<std::int64_t> from;
  for (const auto& marker : fit.markers) {
    names.push_back(marker.name);
    from.push_back(recorded.find(marker.name_in_data));
  }
  auto markers = select_markers(recorded, from, std::move(names), fit.first_frame, motion.time);
  exchange_as_found(fit, markers);
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
                              .up = workflow::up_of(model),
                              .bodies = &bodies,
                              .cycles = cycle_overlays(recording.events, recording.markers.time, motion)});
}

}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/motion_page.h"

#include <Eigen/Geometry>

#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline::internal {
namespace {

constexpr double kShortest_m = 0.01, kLightest_kg = 1e-3;

/// The bodies that each body carries.
std::vector<std::vector<std::size_t>> children_of(const data::ModelDescription& model) {
  std::vector<std::vector<std::size_t>> out(model.bodies.size());
  for (const auto& joint : model.joints)
    if (joint.parent_body_idx >= 0) out[at(joint.parent_body_idx)].push_back(at(joint.child_body_idx));
  return out;
}

/// Where a body ends in the pose of the workspace: in the middle of the origins of those that it carries (a
/// joint may slide, so not where the joint lies), or as far beyond the mass centre as that is from the
/// origin.
Eigen::Vector3d end_of(const data::ModelDescription& model, const model::Workspace& w, std::size_t body,
                       const std::vector<std::size_t>& children) {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  for (const std::size_t child : children) end += w.position[child] / static_cast<double>(children.size());
  if (!children.empty() && (end - w.position[body]).norm() >= kShortest_m) return end;
  return w.position[body] + w.rotation[body] * (2.0 * model.bodies[body].com_in_body);
}

}  // namespace

report::SceneBodies body_positions(const model::Model& model, const data::JointMotion& motion,
                                   const ModelMeshes& meshes) {
  const auto& description = model.description();
  const auto n = static_cast<std::int64_t>(model.coordinate_count());
  check(std::ssize(motion.q) == motion.frames() * n, "the motion is of this model");
  const auto children = children_of(description);
  report::SceneBodies out;
  out.meshes_note = meshes.note;
  std::vector<std::size_t> drawn;
  model::Workspace w(model);
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(motion.q.data() + f * n, n);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::size_t b = 0; f == 0 && b < children.size(); ++b) {
      const auto& body = description.bodies[b];
      const double length_m = (end_of(description, w, b, children[b]) - w.position[b]).norm();
      const auto mesh = meshes.of_body.find(body.name);
      const bool has_mesh = mesh != meshes.of_body.end();
      if (!has_mesh && (!(body.mass > kLightest_kg) || length_m < kShortest_m)) continue;
      drawn.push_back(b);
      if (!meshes.of_body.empty()) out.meshes.push_back(has_mesh ? mesh->second : data::TriangleMesh{});
      out.names.push_back(body.name);
      out.mass_kg.push_back(body.mass);
    }
    for (const std::size_t b : drawn) {
      const Eigen::Vector3d origin = w.position[b], end = end_of(description, w, b, children[b]);
      out.origin_in_world.insert(out.origin_in_world.end(), origin.data(), origin.data() + 3);
      out.end_in_world.insert(out.end_in_world.end(), end.data(), end.data() + 3);
      if (meshes.of_body.empty()) continue;
      const Eigen::Quaterniond turn(w.rotation[b]);
      out.world_from_body.insert(out.world_from_body.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
    }
  }
  return out;
}

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

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"

#include "kinemark/pipeline/motion/internal/body_places.h"

namespace kinemark::pipeline::internal {
namespace {

constexpr double kShortest_m = 0.01;

/// The end of each body in its own axes.
std::vector<Eigen::Vector3d> ends_of(const data::ModelDescription& model) {
  std::vector<Eigen::Vector3d> sum(model.bodies.size(), Eigen::Vector3d::Zero());
  std::vector<int> children(model.bodies.size(), 0);
  for (const auto& joint : model.joints) {
    if (joint.parent_body_idx < 0) continue;
    sum[at(joint.parent_body_idx)] += joint.parent_from_joint.translation;
    ++children[at(joint.parent_body_idx)];
  }
  for (std::size_t b = 0; b < sum.size(); ++b) {
    if (children[b] > 0) sum[b] /= children[b];
    // A trunk whose limbs meet near its origin, or an end segment.
    if (sum[b].norm() < kShortest_m || children[b] == 0) sum[b] = 2.0 * model.bodies[b].com_in_body;
  }
  return sum;
}

}  // namespace

report::SceneBodies body_places(const model::Model& model, const data::JointMotion& motion) {
  const auto& description = model.description();
  const auto n = static_cast<std::int64_t>(model.coordinate_count());
  check(std::ssize(motion.q) == motion.frames() * n, "the motion is of this model");
  const auto ends = ends_of(description);
  report::SceneBodies out;
  std::vector<std::size_t> drawn;
  for (std::size_t b = 0; b < ends.size(); ++b) {
    const auto& body = description.bodies[b];
    if (!(body.mass > 1e-3) || ends[b].norm() < kShortest_m) continue;
    drawn.push_back(b);
    out.names.push_back(body.name);
    out.mass_kg.push_back(body.mass);
  }
  model::Workspace w(model);
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(motion.q.data() + f * n, n);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (const std::size_t b : drawn) {
      const Eigen::Vector3d origin = w.position[b], end = origin + w.rotation[b] * ends[b];
      out.origin_in_world.insert(out.origin_in_world.end(), origin.data(), origin.data() + 3);
      out.end_in_world.insert(out.end_in_world.end(), end.data(), end.data() + 3);
    }
  }
  return out;
}

}  // namespace kinemark::pipeline::internal

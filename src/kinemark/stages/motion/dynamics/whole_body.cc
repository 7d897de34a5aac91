// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/whole_body.h"

#include <fmt/core.h>

#include <Eigen/Geometry>

#include "kinemark/core/index.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

double mass_of(const model::Model& model) {
  double mass = 0.0;
  for (const auto& body : model.bodies()) mass += body.mass;
  return mass;
}

// The bodies of a workspace that kinematics() and velocities() have filled.
void add_frame(const model::Model& model, const model::Workspace& w, std::int64_t f, WholeBody& out) {
  Vector3d centre = Vector3d::Zero(), velocity = Vector3d::Zero();
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vector3d x = model::point_in_world(w, static_cast<int>(b), bodies[b].com_in_body);
    centre += bodies[b].mass / out.mass_kg * x;
    velocity += bodies[b].mass / out.mass_kg * model::point_velocity(w, static_cast<int>(b), x);
  }
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vector3d x = model::point_in_world(w, static_cast<int>(b), bodies[b].com_in_body);
    const Vector3d v = model::point_velocity(w, static_cast<int>(b), x);
    const Matrix3d& r = w.rotation[b];
    momentum += bodies[b].mass * (x - centre).cross(v - velocity) +
                r * (bodies[b].inertia_about_com * (r.transpose() * w.body_velocity[b].w));
  }
  out.centre.row(f) = centre;
  out.centre_velocity.row(f) = velocity;
  out.momentum.row(f) = momentum;
}

}  // namespace

Result<WholeBody> whole_body(const model::Model& model, const data::JointMotion& motion,
                             const std::vector<PointOnBody>& points) {
  if (motion.size() != model.coordinate_count() || motion.qd.size() != motion.q.size())
    return fail(Code::bad_input,
                fmt::format("the motion has {} coordinates and {} speeds, the model {} of "
                            "both",
                            motion.size(), motion.qd.empty() ? 0 : motion.size(), model.coordinate_count()));
  const std::int64_t frames = motion.frames();
  WholeBody out{.mass_kg = mass_of(model),
                .centre = Eigen::MatrixX3d(frames, 3),
                .centre_velocity = Eigen::MatrixX3d(frames, 3),
                .momentum = Eigen::MatrixX3d(frames, 3),
                .points = std::vector(points.size(), Eigen::MatrixX3d(frames, 3))};
  if (!(out.mass_kg > 0.0))
    return fail(Code::bad_input,
                fmt::format("model '{}' has no mass, and so no mass centre", model.description().name));
  const auto n = motion.size();
  model::Workspace w(model);
  VectorXd v, vdot;
  const VectorXd still = VectorXd::Zero(n);
  for (std::int64_t f = 0; f < frames; ++f) {
    const Eigen::Map<const VectorXd> q(motion.q.data() + motion.index(f, 0), n),
        qd(motion.qd.data() + motion.index(f, 0), n);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    model::speeds_from_rates(model, q, qd, still, v, vdot);
    model::velocities(model, w, v);
    add_frame(model, w, f, out);
    for (std::size_t p = 0; p < points.size(); ++p)
      out.points[p].row(f) = model::point_in_world(w, points[p].body, points[p].x_in_body);
  }
  return out;
}

}  // namespace kinemark::motion

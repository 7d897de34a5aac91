// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/dynamics.h"

#include "kinemark/core/index.h"
#include "kinemark/model/internal/composite.h"

namespace kinemark::model {
namespace {

using internal::apply;

// Inertia of every body about the world origin.
void body_inertias(const Model& model, Workspace& w) {
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vector3d com = w.position[b] + w.rotation[b] * bodies[b].com_in_body;
    SpatialInertia& inertia = w.inertia[b];
    inertia.mass = bodies[b].mass;
    inertia.first = bodies[b].mass * com;
    const Matrix3d rotated = w.rotation[b] * bodies[b].inertia_about_com;
    inertia.second.noalias() = rotated * w.rotation[b].transpose();
    inertia.second.diagonal().array() += inertia.first.dot(com);
    inertia.second.noalias() -= inertia.first * com.transpose();
  }
}

}  // namespace

namespace internal {

void project_composites(const Model& model, Workspace& w, Eigen::MatrixXd& H) {
  H.setZero(model.speed_count(), model.speed_count());
  const auto bodies = model.bodies();
  const auto columns = model.columns();
  for (int b = static_cast<int>(bodies.size()) - 1; b >= 0; --b) {
    const Model::Body& body = bodies[at(b)];
    const SpatialInertia& carried = w.composite[at(b)];
    if (body.parent >= 0) {
      SpatialInertia& parent = w.composite[at(body.parent)];
      parent.mass += carried.mass;
      parent.first += carried.first;
      parent.second += carried.second;
    }
    if (carried.mass == 0.0 && carried.second.isZero(0.0)) continue;
    for (int c = body.first_column; c < body.last_column; ++c) {
      const Spatial f = apply(carried, w.column[at(c)]);
      const int row = columns[at(c)].speed;
      for (const int d : body.support) {
        const double h = dot(w.column[at(d)], f);
        const int col = columns[at(d)].speed;
        H(row, col) += h;
        if (d == c) break;  // the support lists this joint's own columns last and in order
        H(col, row) += h;
      }
    }
  }
}

void project_forces(const Model& model, Workspace& w, VectorXd& g) {
  g.setZero(model.speed_count());
  const auto bodies = model.bodies();
  for (int b = static_cast<int>(bodies.size()) - 1; b >= 0; --b) {
    const Model::Body& body = bodies[at(b)];
    const Spatial& carried = w.force[at(b)];
    for (int c = body.first_column; c < body.last_column; ++c)
      g[model.columns()[at(c)].speed] += dot(w.column[at(c)], carried);
    if (body.parent >= 0) {
      w.force[at(body.parent)].w += carried.w;
      w.force[at(body.parent)].v += carried.v;
    }
  }
}

}  // namespace internal

void mass_matrix(const Model& model, Workspace& w, Eigen::MatrixXd& M) {
  body_inertias(model, w);
  w.composite = w.inertia;
  internal::project_composites(model, w, M);
}

void bias_forces(const Model& model, Workspace& w, VectorXd& b) {
  body_inertias(model, w);
  for (std::size_t i = 0; i < w.force.size(); ++i) {
    // Rate of momentum at zero vdot: I a + u x* (I u).
    const Spatial& u = w.body_velocity[i];
    Spatial f = apply(w.inertia[i], w.body_bias[i]);
    const Spatial momentum = apply(w.inertia[i], u);
    f.w += u.w.cross(momentum.w) + u.v.cross(momentum.v);
    f.v += u.w.cross(momentum.v);
    w.force[i] = f;
  }
  internal::project_forces(model, w, b);
}

void gravity_forces(const Model& model, Workspace& w, VectorXd& g) {
  const auto bodies = model.bodies();
  const Vector3d upward = -model.gravity();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vector3d com = w.position[i] + w.rotation[i] * bodies[i].com_in_body;
    const Vector3d f = bodies[i].mass * upward;
    w.force[i] = {com.cross(f), f};
  }
  internal::project_forces(model, w, g);
}

void inverse_dynamics(const Model& model, Workspace& w, const VectorXd& vdot, VectorXd& tau) {
  body_inertias(model, w);
  const auto bodies = model.bodies();
  // Accelerations first (stored in the place of the forces), parents before children; gravity enters as an
  // upward acceleration of the ground.
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Spatial a =
        bodies[b].parent >= 0 ? w.force[at(bodies[b].parent)] : Spatial{Vector3d::Zero(), -model.gravity()};
    for (int c = bodies[b].first_column; c < bodies[b].last_column; ++c) {
      const double rate = vdot[model.columns()[at(c)].speed];
      a.w += rate * w.column[at(c)].w;
      a.v += rate * w.column[at(c)].v;
    }
    w.force[b] = a;
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Spatial a = {w.force[b].w + w.body_bias[b].w, w.force[b].v + w.body_bias[b].v};
    const Spatial& u = w.body_velocity[b];
    const Spatial momentum = apply(w.inertia[b], u);
    Spatial f = apply(w.inertia[b], a);
    f.w += u.w.cross(momentum.w) + u.v.cross(momentum.v);
    f.v += u.w.cross(momentum.v);
    w.force[b] = f;
  }
  internal::project_forces(model, w, tau);
}

double kinetic_energy(const Model& model, const Workspace& w) {
  double energy = 0.0;
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vector3d com = w.position[b] + w.rotation[b] * bodies[b].com_in_body;
    const Spatial& u = w.body_velocity[b];
    const Vector3d velocity = u.v + u.w.cross(com);
    const Vector3d spin = w.rotation[b].transpose() * u.w;
    energy += 0.5 * (bodies[b].mass * velocity.squaredNorm() + spin.dot(bodies[b].inertia_about_com * spin));
  }
  return energy;
}

double potential_energy(const Model& model, const Workspace& w) {
  double energy = 0.0;
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    energy -= bodies[b].mass * model.gravity().dot(w.position[b] + w.rotation[b] * bodies[b].com_in_body);
  return energy;
}

}  // namespace kinemark::model

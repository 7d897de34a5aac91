// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/mixed_bars.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/bar_limits.h"
#include "kinemark/stages/motion/internal/normal_inverse.h"
#include "kinemark/stages/motion/internal/profile_errors.h"
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

namespace kinemark::motion::internal {
namespace {

std::string corner_name(std::size_t sensor, int corner) {
  return fmt::format("sensor {} corner {}", sensor, corner);
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUnitLever = 2.0;  // m^2: three points 1 m off, on three axes, turn with a body so

/// One frame: pose, markers seen, sensors present, normal matrices.
struct Frame {
  Frame(const Problem& p, const TurnedBodies& s)
      : problem(p),
        sensors(s),
        markers(p.model.marker_count() - kCorners * static_cast<Eigen::Index>(s.size())),
        w(p.model),
        y(3, p.model.marker_count()),
        weight(p.model.marker_count()),
        of_markers(p.model.marker_count()),
        A(3, p.model.speed_count()),
        inverse(p) {}

  void visit(const data::Trajectories& points, const MatrixXd& states, std::int64_t f) {
    index = at(f);
    problem.observe(points, f, y, weight);
    of_markers = weight;
    of_markers.tail(weight.size() - markers).setZero();
    present = 0.0;
    for (std::size_t s = 0; s < sensors.size(); ++s) present += sensors.present(index, s) ? 1.0 : 0.0;
    model::kinematics(problem.model, w, states.col(f));
    if (!problem.model.point_constraints().empty()) model::point_constraint_jacobian(problem.model, w, C);
  }

  [[nodiscard]] bool empty() const { return of_markers.sum() == 0.0 && present == 0.0; }
  /// Variance of a marker over that of an orientation, m^2: what a squared rad weighs.
  [[nodiscard]] double turn_weight() const { return sensors.marker_variance / sensors.noise_variance; }

  /// H += sum over sensors of weight(s) A'A.
  template <class Weight>
  void add_turns(Weight&& weight_of, MatrixXd& into) {
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      if (!sensors.present(index, s)) continue;
      turning_jacobian(problem.model, w, sensors.body[s], A);
      into.noalias() += weight_of(s) * A.transpose() * A;
    }
  }

  /// K = (J'WJ + turns + tasks)^-1; E must be set when there are tasks.
  void inverse_normal_matrix() {
    model::marker_normal_matrix(problem.model, w, of_markers, H);
    marker_part = H;
    add_turns([&](std::size_t) { return turn_weight(); }, H);
    const double total = weight.sum();
    for (const auto& task : problem.coordinate_tasks)
      H.noalias() += total * task.weight * E.row(task.coordinate).transpose() * E.row(task.coordinate);
    inverse.invert(H, C, kBarFloor * (total + present * turn_weight()), K);
  }

  /// Angle between a body and what its sensor says, squared, rad^2.
  [[nodiscard]] double squared_angle(std::size_t s) const {
    const Eigen::Matrix3d& body = w.rotation[at(sensors.body[s])];
    const double angle =
        Eigen::AngleAxisd(body.transpose() * sensors.turned[index * sensors.size() + s]).angle();
    return angle * angle;
  }

  const Problem& problem;
  const TurnedBodies& sensors;
  Eigen::Index markers;
  model::Workspace w;
  Eigen::Matrix3Xd y;
  VectorXd weight, of_markers;
  MatrixXd H, K, C, E, A, marker_part;
  NormalInverse inverse;
  std::size_t index = 0;
  double present = 0.0;
};

/// Errors that the markers of a segment share: common variance times the square of their summed Jacobian.
void add_common(Frame& frame, const MarkerVariances& variances, MatrixXd& segment, MatrixXd& B) {
  const auto& model = frame.problem.model;
  for (Eigen::Index b = 0; b < variances.common.size(); ++b) {
    if (variances.common[b] == 0.0) continue;
    segment.setZero(3, model.speed_count());
    for (Eigen::Index m = 0; m < frame.markers; ++m) {
      if (model.markers()[at(m)].body != b || frame.weight[m] == 0.0) continue;
      for (const int column : model.bodies()[at(b)].support) {
        const auto& s = frame.w.column[at(column)];
        segment.col(model.columns()[at(column)].speed) +=
            frame.weight[m] * (s.v + s.w.cross(Eigen::Vector3d(frame.w.marker.col(m))));
      }
    }
    B.noalias() += variances.common[b] * segment.transpose() * segment;
  }
}

/// Which coordinates markers and sensors of the frame determine, whatever their noise.
void find_determined(Frame& frame, MatrixXd& unit_H, MatrixXd& unit_K, data::JointMotion& motion,
                     std::vector<std::uint8_t>& open) {
  const auto f = static_cast<std::int64_t>(frame.index);
  const VectorXd seen = (frame.of_markers.array() > 0.0).cast<double>();
  model::marker_normal_matrix(frame.problem.model, frame.w, seen, unit_H);
  frame.add_turns([](std::size_t) { return kUnitLever; }, unit_H);
  frame.inverse.invert(unit_H, frame.C, kBlindFloor * (seen.sum() + 3.0 * frame.present), unit_K);
  const MatrixXd rows = frame.E * unit_K;
  for (Eigen::Index c = 0; c < frame.E.rows(); ++c) {
    const double per_metre = std::sqrt(std::max(0.0, rows.row(c).dot(frame.E.row(c))));
    const bool fixed = per_metre <= (motion.is_rotation[at(c)] ? kBlindRotation : kBlindTranslation);
    motion.determined[motion.index(f, c)] = fixed ? 1 : 0;
    open[motion.index(f, c)] = fixed ? 0 : 1;
  }
}

/// Change of the coordinates for one rad of the heading.
VectorXd slope_on_heading(Frame& frame) {
  VectorXd force = VectorXd::Zero(frame.problem.model.speed_count());
  for (std::size_t s = 0; s < frame.sensors.size(); ++s) {
    if (!frame.sensors.present(frame.index, s)) continue;
    turning_jacobian(frame.problem.model, frame.w, frame.sensors.body[s], frame.A);
    force += frame.turn_weight() * frame.A.transpose() *
             frame.sensors.by_heading[frame.index * frame.sensors.size() + s];
  }
  return frame.E * (frame.K * force);
}

}  // namespace

Eigen::Matrix<double, 3, kCorners> far_corners() {
  Eigen::Matrix<double, 3, kCorners> corners;
  corners << 1.0, 1.0, -1.0, -1.0,  //
      1.0, -1.0, 1.0, -1.0,         //
      1.0, -1.0, -1.0, 1.0;
  return 0.5 * kFar_m * corners;
}

double far_weight(double marker_variance_m2, double orientation_variance_rad2) {
  // |R - S|^2 is twice the squared angle.
  return marker_variance_m2 / (2.0 * kFar_m * kFar_m * orientation_variance_rad2);
}

data::ModelDescription add_far_points(data::ModelDescription model, const std::vector<int>& bodies) {
  const auto corners = far_corners();
  for (std::size_t s = 0; s < bodies.size(); ++s)
    for (int k = 0; k < kCorners; ++k)
      model.markers.push_back(
          {.name = corner_name(s, k), .body_idx = bodies[s], .x_in_body = corners.col(k)});
  return model;
}

data::Trajectories add_far_points(const data::Trajectories& markers,
                                  const std::vector<Eigen::Matrix3d>& turned,
                                  const std::vector<Eigen::Vector3d>& origin) {
  const auto F = at(markers.frames()), M = markers.names.size();
  const std::size_t S = F == 0 ? 0 : turned.size() / F;
  data::Trajectories out;
  out.time = markers.time;
  out.names = markers.names;
  for (std::size_t s = 0; s < S; ++s)
    for (int k = 0; k < kCorners; ++k) out.names.push_back(corner_name(s, k));
  const std::size_t all = M + S * at(kCorners);
  out.x_in_world.assign(3 * F * all, kNaN);
  out.state.assign(F * all, data::SampleState::missing);
  const auto corners = far_corners();
  for (std::size_t f = 0; f < F; ++f) {
    std::copy_n(markers.x_in_world.data() + 3 * f * M, 3 * M, out.x_in_world.data() + 3 * f * all);
    std::copy_n(markers.state.data() + f * M, M, out.state.data() + f * all);
    for (std::size_t s = 0; s < S; ++s) {
      const Eigen::Matrix3d& R = turned[f * S + s];
      if (!R.allFinite()) continue;
      for (int k = 0; k < kCorners; ++k) {
        const std::size_t sample = f * all + M + s * at(kCorners) + at(k);
        Eigen::Map<Eigen::Vector3d>(out.x_in_world.data() + 3 * sample) =
            origin[f * S + s] + R * corners.col(k);
        out.state[sample] = data::SampleState::measured;
      }
    }
  }
  return out;
}

MixedNoise estimate_mixed_noise(const Problem& problem, const data::Trajectories& points,
                                const MatrixXd& states, const TurnedBodies& sensors) {
  Frame frame(problem, sensors);
  const int n = problem.model.coordinate_count();
  VectorXd q = VectorXd::Zero(n);
  double marker_squares = 0.0, marker_freedom = 0.0, sensor_squares = 0.0, sensor_freedom = 0.0;
  const std::int64_t stride = (problem.frames + kSampledFrames - 1) / kSampledFrames;
  for (std::int64_t f = 0; f < problem.frames; f += stride) {
    frame.visit(points, states, f);
    if (frame.empty()) continue;
    if (!problem.coordinate_tasks.empty()) {
      model::coordinates_from_state(problem.model, states.col(f), q, q);
      model::coordinate_jacobian(problem.model, frame.w, q, frame.E);
    }
    frame.inverse_normal_matrix();
    MatrixXd turns = MatrixXd::Zero(frame.K.rows(), frame.K.cols());
    frame.add_turns([&](std::size_t) { return frame.turn_weight(); }, turns);
    for (Eigen::Index m = 0; m < frame.markers; ++m) {
      if (frame.weight[m] == 0.0) continue;
      marker_squares += frame.weight[m] * (frame.y.col(m) - frame.w.marker.col(m)).squaredNorm();
      marker_freedom += 3.0;
    }
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sensors.present(frame.index, s)) sensor_squares += frame.squared_angle(s);
    marker_freedom -= frame.K.cwiseProduct(frame.marker_part).sum();
    sensor_freedom += 3.0 * frame.present - frame.K.cwiseProduct(turns).sum();
  }
  MixedNoise out;
  if (marker_freedom > 1.0) out.marker_variance = marker_squares / marker_freedom;
  if (sensor_freedom > 1.0) out.sensor_variance = sensor_squares / sensor_freedom;
  return out;
}

void compute_mixed_bars(const Problem& problem, const data::Trajectories& points, const MatrixXd& states,
                        const MarkerVariances& variances, const TurnedBodies& sensors, int threads,
                        data::JointMotion& motion) {
  const auto& model = problem.model;
  const int n = model.coordinate_count();
  motion.q_sd.assign(motion.q.size(), kNaN);
  motion.determined.assign(motion.q.size(), 0);
  std::vector<std::uint8_t> open(motion.q.size(), 1);
  const VectorXd all = information_of(model, variances);
  parallel_for(problem.frames, 16, threads, [&](std::int64_t begin, std::int64_t end) {
    Frame frame(problem, sensors);
    ProfileErrors profile(problem);
    MatrixXd unit_H, unit_K, B, segment;
    VectorXd variance(n);
    for (std::int64_t f = begin; f < end; ++f) {
      frame.visit(points, states, f);
      if (frame.empty()) continue;
      const VectorXd q = Eigen::Map<const VectorXd>(motion.q.data() + motion.index(f, 0), n);
      model::coordinate_jacobian(model, frame.w, q, frame.E);
      find_determined(frame, unit_H, unit_K, motion, open);
      // Sandwich: K (J'W S W J + turns) K.
      frame.inverse_normal_matrix();
      const VectorXd spread = frame.of_markers.cwiseAbs2().cwiseProduct(variances.own);
      model::marker_normal_matrix(model, frame.w, spread, B);
      add_common(frame, variances, segment, B);
      const double weight = frame.turn_weight();
      frame.add_turns(
          [&](std::size_t s) {
            return weight * weight *
                   (sensors.noise_variance * (1.0 + sensors.placing_share[s]) + sensors.placing_variance[s]);
          },
          B);
      const MatrixXd rows = frame.E * frame.K;
      const VectorXd information = (frame.weight.array() > 0.0).select(all, 0.0);
      std::uint8_t* determined = motion.determined.data() + motion.index(f, 0);
      bool vague = false;
      for (int c = 0; c < n; ++c) {
        variance[c] = rows.row(c).dot(B * rows.row(c).transpose());
        vague = vague || determined[c] == 0 || variance[c] > kVague * kVague;
      }
      if (vague && information != all)
        profile.add(states.col(f), frame.y, information, all, frame.E, variance);
      if (sensors.heading_variance > 0.0)
        variance += sensors.heading_variance * slope_on_heading(frame).cwiseAbs2();
      for (int c = 0; c < n; ++c) {
        if (determined[c] == 0) continue;
        const int speed = problem.speed_of(c);
        const bool locked = speed >= 0 && problem.fixed_speed[at(speed)] != 0;
        const double sd = locked ? 0.0 : std::sqrt(std::max(0.0, variance[c]));
        if (sd <= kLargestSd)
          motion.q_sd[motion.index(f, c)] = sd;
        else
          determined[c] = 0;
      }
    }
  });
  motion.open_frames.assign(at(n), 0);
  for (std::size_t i = 0; i < open.size(); ++i) motion.open_frames[i % at(n)] += open[i];
}

}  // namespace kinemark::motion::internal

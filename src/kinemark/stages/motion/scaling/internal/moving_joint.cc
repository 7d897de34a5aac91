// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/moving_joint.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/scaling/internal/schur.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kUnknownShift_m = 0.1;  // prior of a shift, for directions that the markers do not determine
constexpr double kNotable_m = 0.008;     // larger shifts exclude a rigid shoulder girdle
constexpr double kAboveNoise = 2.0;

}  // namespace

JointShift measure_shift(const Problem& problem, const data::Trajectories& markers, const MatrixXd& states,
                         int body, double noise_sd_m) {
  const auto& joint_body = problem.model.bodies()[at(body)];
  // The joint's own three offsets are the only parameters.
  const auto& description = problem.model.description();
  std::vector<GeometryParameter> offsets(3);
  for (std::size_t j = 0; j < description.joints.size(); ++j)
    if (description.joints[j].child_body_idx == joint_body.description_idx)
      for (int axis = 0; axis < 3; ++axis)
        offsets[at(axis)].terms = {{.moves = GeometryTerm::Moves::parent_frame,
                                    .idx = static_cast<int>(j),
                                    .direction = Vector3d::Unit(axis)}};
  const GeometryLayout layout(problem, description, offsets);
  FrameEquations frame(problem, layout);
  Eigen::Matrix3Xd y(3, problem.model.marker_count());
  VectorXd weight(problem.model.marker_count());
  JointShift shift;
  double frames = 0.0, noise = 0.0, squares = 0.0;
  const double prior = noise_sd_m * noise_sd_m / (kUnknownShift_m * kUnknownShift_m);
  std::vector<Vector3d> shifts;
  Vector3d mean = Vector3d::Zero();
  for (std::int64_t f = 0; f < problem.frames; ++f) {
    problem.observe(markers, f, y, weight);
    if (weight.sum() == 0.0) continue;
    frame.visit(y, weight, states.col(f));
    NormalSums sums(3);
    frame.add_to(sums);
    Matrix3d S = MatrixXd(sums.S.selfadjointView<Eigen::Lower>());
    S.diagonal().array() += prior;
    const Matrix3d inverse = S.inverse();
    shifts.emplace_back(inverse * sums.g);
    mean += shifts.back();
    noise += noise_sd_m * noise_sd_m * (inverse.trace() - prior * (inverse * inverse).trace());
    frames += 1.0;
  }
  if (frames == 0.0) return shift;
  mean /= frames;
  for (const auto& s : shifts) squares += (s - mean).squaredNorm();
  shift.rms_m = std::sqrt(squares / frames);
  shift.by_noise_m = std::sqrt(std::max(0.0, noise / frames));
  return shift;
}

std::vector<std::string> recommend_joints(const Problem& problem, const data::Trajectories& markers,
                                          const MatrixXd& states, double noise_sd_m) {
  std::vector<std::string> sentences;
  const auto bodies = problem.model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& name = problem.model.description().bodies[at(bodies[b].description_idx)].name;
    const int parent = bodies[b].parent;
    if (!name.starts_with("humerus") || parent < 0) continue;
    const auto& girdle = problem.model.description().bodies[at(bodies[at(parent)].description_idx)].name;
    const bool moves = bodies[at(parent)].first_column < bodies[at(parent)].last_column;
    if (moves && (girdle.starts_with("clavicle") || girdle.starts_with("scapula"))) continue;
    const JointShift shift = measure_shift(problem, markers, states, static_cast<int>(b), noise_sd_m);
    if (shift.rms_m < kNotable_m || shift.rms_m < kAboveNoise * shift.by_noise_m) continue;
    sentences.push_back(
        fmt::format("the shoulder of '{}' moves by {:.0f} mm RMS in '{}', which holds it "
                    "fixed: give the model clavicles",
                    name, 1e3 * shift.rms_m, girdle));
  }
  return sentences;
}

}  // namespace kinemark::motion::internal

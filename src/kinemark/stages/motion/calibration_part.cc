// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/bar_limits.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/normal_inverse.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One thread's linear map of a frame: from displacements of its markers to the coordinates.
class FrameMap {
 public:
  explicit FrameMap(const internal::Problem& problem)
      : problem_(problem), w_(problem.model), inverse_(problem), weight_(problem.model.marker_count()) {}

  /// The frame as it was solved: q, and the markers that were used. False: none is.
  bool visit(const data::Trajectories& markers, const data::JointMotion& motion, std::int64_t f) {
    const auto& model = problem_.model;
    problem_.observe(markers, f, y_, weight_);
    if (!motion.marker_state.empty())
      for (Eigen::Index m = 0; m < weight_.size(); ++m)
        if (motion.marker_state[static_cast<std::size_t>(f * weight_.size() + m)] ==
            data::SampleState::rejected)
          weight_[m] = 0.0;
    if (weight_.sum() == 0.0) return false;
    const VectorXd q = Eigen::Map<const VectorXd>(motion.q.data() + motion.index(f, 0), motion.size());
    model::kinematics(model, w_, model::state_from_coordinates(model, q));
    if (!model.point_constraints().empty()) model::point_constraint_jacobian(model, w_, C_);
    model::marker_normal_matrix(model, w_, weight_, H_);
    model::coordinate_jacobian(model, w_, q, E_);
    if (!problem_.coordinate_tasks.empty()) add_tasks();
    inverse_.invert(H_, C_, internal::kBarFloor * weight_.sum(), K_);
    model::marker_jacobian(model, w_, J_);
    for (Eigen::Index m = 0; m < weight_.size(); ++m) J_.middleRows<3>(3 * m) *= weight_[m];
    map_.noalias() = E_ * (K_ * J_.transpose());
    return true;
  }

  /// Variance of each coordinate (n) when all markers are displaced by each field with a factor of
  /// variance 1.
  [[nodiscard]] VectorXd variance(const data::CalibrationError& error) const {
    VectorXd out = VectorXd::Zero(map_.rows());
    const data::Points at_markers = y_.transpose();
    for (const auto& field : data::displacements(error, at_markers))
      out += (map_ * field.transpose().reshaped()).cwiseAbs2();
    return out;
  }

 private:
  void add_tasks() {
    const double total = weight_.sum();
    for (const auto& task : problem_.coordinate_tasks)
      H_.noalias() += total * task.weight * E_.row(task.coordinate).transpose() * E_.row(task.coordinate);
  }

  const internal::Problem& problem_;
  model::Workspace w_;
  internal::NormalInverse inverse_;
  VectorXd weight_;
  Eigen::Matrix3Xd y_ = Eigen::Matrix3Xd::Zero(3, problem_.model.marker_count());
  MatrixXd H_, K_, C_, E_, J_, map_;
};

}  // namespace

Status add_calibration_error(const model::Model& model, const data::Trajectories& markers,
                             const data::CalibrationError& error, const IkOptions& options,
                             data::JointMotion& motion) {
  if (!error.known() || motion.q_sd.empty()) return {};
  const auto problem = internal::make_problem(model, markers, options);
  if (!problem) return std::unexpected(problem.error());
  kinemark::check(problem->frames == motion.frames() && model.coordinate_count() == motion.size(),
                  "the motion is of these markers");
  parallel_for(problem->frames, 16, options.threads, [&](std::int64_t begin, std::int64_t end) {
    FrameMap map(*problem);
    for (std::int64_t f = begin; f < end; ++f) {
      if (!map.visit(markers, motion, f)) continue;
      const VectorXd more = map.variance(error);
      for (std::int64_t c = 0; c < motion.size(); ++c) {
        const auto i = motion.index(f, c);
        if (motion.determined[i] == 0) continue;
        internal::widen(motion, i, more[c]);
      }
    }
  });
  return {};
}

}  // namespace kinemark::motion

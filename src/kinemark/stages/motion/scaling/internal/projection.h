// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/internal/schur.h"

namespace kinemark::motion::internal {

/// Sums at one geometry with every posture at its best.
struct ProjectedSums {
  explicit ProjectedSums(int columns) : normal(columns) {}
  NormalSums normal;
  double cost = 0.0;              ///< weighted squares and tasks
  std::int64_t moved_speeds = 0;  ///< free speeds of all frames, summed
  [[nodiscard]] double rms() const {
    return normal.seen > 0 ? std::sqrt(normal.squares / static_cast<double>(normal.seen)) : 0.0;
  }
};

/// Geometry in, best postures and the normal equations of the geometry out.
class Projection {
 public:
  Projection(const data::ModelDescription& full, const std::vector<GeometryParameter>& parameters,
             Problem problem, IkOptions options, const data::Trajectories& markers, int threads);

  /// Visit every stride-th frame only.
  void set_frames(std::int64_t stride) { stride_ = stride; }

  /// Solve all frames with the geometry changed by x, from `states` (columns are frames), which improve.
  /// An invalid geometry (numbers that are not finite) has the cost NaN, and the states do not change.
  ProjectedSums solve(const Eigen::VectorXd& x, Eigen::MatrixXd& states);

  /// The normal equations with derivatives at the shrunk states and residuals at the best ones, for the
  /// geometry of the last solve(). The states do not change.
  [[nodiscard]] NormalSums sums_at(const Eigen::MatrixXd& best, const Eigen::MatrixXd& quiet) const;

  /// Also start every frame from its neighbours' postures, with the geometry of the last solve(), and keep
  /// clear improvements. Returns the number of frames that had been in a false minimum.
  std::int64_t free_caught_frames(Eigen::MatrixXd& states) const;

  /// With the geometry of the last solve().
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const GeometryLayout& layout() const { return layout_; }

 private:
  Problem problem_;
  GeometryLayout layout_;
  data::ModelDescription base_;                ///< as given, used markers only
  std::vector<GeometryParameter> parameters_;  ///< by the indices of base_
  IkOptions options_;
  const data::Trajectories& markers_;
  int threads_;
  std::int64_t stride_ = 1;
};

}  // namespace kinemark::motion::internal

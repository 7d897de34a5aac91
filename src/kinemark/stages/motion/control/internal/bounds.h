// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Coordinates determined by the goals of one frame, and bounds on the angle errors (equations 14 to 17 of
// Demircan et al.).
//
// Marker errors dx and angle errors dq satisfy J dq = dx, independent of the controller. Level by level, in z
// = L'dq: the first level explains z_1 = A_1^+ dx_1, the next what is
// left of its own error, z_2 = A_2|1^+ (dx_2 - A_2 z_1), and so on; when all levels together have full
// column rank, z is their sum, and so
//     dq_c = sum over levels of (row c of L^-T A_i|..^+) (dx_i - A_i (z_1 + ... ))      (equation 15)
// and with norms in place of the products the bound of equation 16. The same matrices turn the covariance of
// the goals into that of the angles. Equation 15 determines dq_c uniquely: the difference of the body's
// angles to those that its goals require, zero at the best fit and large while the body still approaches the
// goals. It is the first order of that way, exact for goals that a pose reaches; where the goals are one sum
// of squares that fixes all coordinates, the way itself is taken (best_fit.h); in a frame in which it is not
// found equation 16 stands for it. A coordinate that its goals press against a limit has an error of 0 there
// and takes no part in those of the others; its standard deviation is that of a free one.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <cstdint>
#include <vector>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/control/internal/best_fit.h"
#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/internal/plan.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

class Bounds {
 public:
  explicit Bounds(const Plan& plan);

  /// Equations 15 and 16 assume exact goals; bound() counts this many standard deviations of their noise.
  static constexpr double kNoiseSds = 5.0;
  /// A coordinate with a larger deviation is not determined, rad or m.
  static constexpr double kLargestSd = 0.5;

  /// Evaluate pose x with coordinates q and the goals of this frame.
  void find(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal, double time_s,
            const MarkerVariances& noise);

  /// Standard deviation from the goals' noise, with the error by equation 15 added in quadrature. NaN where
  /// not determined or not known.
  [[nodiscard]] const Eigen::VectorXd& sd() const { return sd_; }
  /// Bound on the error of a coordinate: equation 15 and the goals' noise. NaN where not determined.
  [[nodiscard]] const Eigen::VectorXd& bound() const { return bound_; }
  /// The coordinate that the goals require minus that of the body: the way to the best fit, or its first
  /// order, equation 15. NaN where not determined, and where the
  /// way is not found.
  [[nodiscard]] const Eigen::VectorXd& goal_error() const { return goal_error_; }
  /// Equation 16: bound on the distance to the coordinate that the goals require. NaN where not determined.
  [[nodiscard]] const Eigen::VectorXd& goal_bound() const { return goal_bound_; }
  [[nodiscard]] const std::vector<std::uint8_t>& determined() const { return determined_; }
  /// What an error of each marker (3 x M, m) in the frame of find() changes the coordinates by, to first
  /// order.
  [[nodiscard]] Eigen::VectorXd coordinates_of(const Eigen::Matrix3Xd& error);
  /// Variance of the coordinates by independent errors of the markers, of `variance` (M, m^2) per axis.
  [[nodiscard]] Eigen::VectorXd variance_of(const Eigen::VectorXd& variance) const;
  /// What no change of the pose explains of such an error: m^2 of each marker (M), and how many of its three
  /// directions that leaves (M; 0 where the marker is no goal).
  void unexplained(const Eigen::Matrix3Xd& error, Eigen::VectorXd& squares, Eigen::VectorXd& freedom);
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] double smallest_singular() const { return smallest_; }

 private:
  struct Level {
    Eigen::MatrixXd A, projected, inverse, R, B;
    Eigen::VectorXd dx, scale, variance;
    std::vector<Eigen::MatrixXd> gains;  // of each task: of its goal by its markers; no columns without
    std::vector<std::uint8_t> is_made;   // rows of such tasks
  };
  void gather(std::size_t index, const GoalValues& goal, double time_s, const MarkerVariances& noise);
  /// All levels, and the coordinates in whitened space, with the speeds of `held_` at rest.
  void solve_levels(const Eigen::VectorXd& q, const GoalValues& goal, double time_s,
                    const MarkerVariances& noise);
  void add_level(std::size_t index);
  /// Hold the coordinates that the goals press against a limit; false: there is none.
  bool hold_pressed(const Eigen::VectorXd& x);
  /// Equations 15 and 16 from the levels as they are.
  void measure(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal);
  /// Where the goals are one sum of squares that fixes everything: the way to its best fit in place of the
  /// first order.
  void find_way(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal);
  void find_coordinates(const Eigen::VectorXd& q);
  /// Change of the coordinates by the markers, those that goals of tasks are made of with them.
  void find_marker_gains();
  void judge(const MarkerVariances& noise);
  /// Rows of all levels in one vector; 0 where nothing of a row is a marker that is seen.
  void stack(const Eigen::Matrix3Xd& error);

  const Plan& plan_;
  model::Workspace w_;
  BestFit fit_;
  std::vector<Level> levels_;
  std::vector<Eigen::Index> first_column_;
  TaskRows rows_;
  Eigen::MatrixXd M_, mass_, J_, V_, E_, C_, explained_, G_, marker_gains_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::VectorXd z_, still_, sd_, bound_, goal_error_, goal_bound_, beyond_, force_, stacked_;
  std::vector<std::uint8_t> determined_, held_;
  bool is_way_known_ = true;
  int rank_ = 0;
  double smallest_ = 0.0;
};

}  // namespace kinemark::motion::internal

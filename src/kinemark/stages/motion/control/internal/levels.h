// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Several levels: their weights in one sum of squares, and what strict ones can keep.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/stages/motion/control/internal/plan.h"

namespace kinemark::motion::internal {

struct Track;

/// m, RMS distance of a strict level to its goals where no run before says how near it can be.
inline constexpr double kUsualBound_m = 0.02;

/// Weights as given; else each level weighs four times as much as the next.
[[nodiscard]] std::vector<double> first_weights(const std::vector<TrackLevel>& levels);

/// Whether a run with equal weights must come first: to find weights, or bounds of strict levels.
[[nodiscard]] bool needs_first_run(const Plan& plan, const TrackOptions& options);

/// Solve all levels as one in which the squared errors of each count by its weight; on average over all rows
/// they count 1.
void join_levels(Plan& plan, const std::vector<double>& weights);

/// 1 / variance of the markers of each level, 100 for 1 at most, as a body shows that followed all of them
/// alike. None where the pose explains nearly everything, or a level holds no markers.
[[nodiscard]] std::optional<std::vector<double>> find_level_weights(const Plan& plan, const Track& track,
                                                                    const std::vector<int>& rank,
                                                                    int threads);

/// Errors of the levels as asked for in one frame.
class LevelErrors {
 public:
  explicit LevelErrors(const Plan& plan);
  /// RMS distance to the goals, m, per level; NaN where it has none. `w` holds kinematics() and velocities().
  const Eigen::VectorXd& find(const model::Workspace& w, const GoalValues& goal, double time_s);
  [[nodiscard]] const Eigen::VectorXd& found() const { return errors_; }

 private:
  const Plan& plan_;
  TaskRows rows_;
  Eigen::VectorXd errors_;
};

/// Bounds for strict levels from a body that followed all of them alike: what a level's error exceeds in
/// one frame of ten, and five standard deviations of the noise of its goals (`noise`, M, variance per axis,
/// m^2).
[[nodiscard]] std::vector<double> find_level_bounds(const Plan& plan, const Track& track,
                                                    const Eigen::VectorXd& noise);

/// A pose in which strict levels came to rest on their goals.
struct LevelCheck {
  double time_s = 0.0;
  Eigen::VectorXd errors_m;  ///< per level
};

/// What strict levels leave at the first frame and every second after it, begun from the poses of a body that
/// followed all levels alike: their own control, with goals that stand still.
[[nodiscard]] std::vector<LevelCheck> check_strict(const Plan& strict, const Track& track);

/// One sentence on levels that are beyond their bounds in such poses; empty where none is. `most`: in more
/// than half of the poses some level is.
[[nodiscard]] std::string describe_checks(const Plan& strict, const std::vector<LevelCheck>& checks,
                                          bool& most);

}  // namespace kinemark::motion::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control of sets of landmarks, measured beside least squares on the same goals.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::studies {

/// Landmarks that are tracked together, at levels of priority.
struct LandmarkSet {
  std::string name;
  std::vector<std::vector<std::string>> levels;
  [[nodiscard]] std::vector<std::string> all() const;
};

[[nodiscard]] LandmarkSet paper_set();  ///< right shoulder and left wrist, then left elbow and right wrist
[[nodiscard]] LandmarkSet pelvis_paper_set();       ///< pelvis and hips before these
[[nodiscard]] LandmarkSet upper_body_set();         ///< 12 landmarks of trunk, head and arms
[[nodiscard]] LandmarkSet upper_body_pelvis_set();  ///< and pelvis and hips
[[nodiscard]] LandmarkSet whole_body_set();         ///< all 21 at one level
[[nodiscard]] LandmarkSet three_level_set();        ///< trunk; middle; ends

struct ControlSetting {
  double step_s = 0.001;
  double omega_rad_s = 0.0;  ///< 0: 100 at steps to 5 ms, 30 beyond
  double damping = 0.1;
  double posture_kp = 100.0, posture_kd = 20.0;
  std::int64_t first_frame = 0, last_frame = -1;  ///< [first, last]; -1: to the end
  bool error_bars = false;
  bool limits = false;
};

/// Track a set's landmarks. Goals are taken as they are: the recording is low-passed already. The posture to
/// return to is `rest`, one number per coordinate.
[[nodiscard]] Result<motion::TrackResult> run_control(const model::Model& model,
                                                      const data::Trajectories& goals, const LandmarkSet& set,
                                                      const ControlSetting& setting,
                                                      const Eigen::VectorXd& rest);

/// Track and least squares on the same goals, frames from one second on. Which coordinates are determined is
/// known only for tracks with error bars.
struct ControlComparison {
  std::string set;
  double least_squares_rms_m = 0.0, least_squares_max_m = 0.0;  ///< landmark to goal
  double control_rms_m = 0.0, control_max_m = 0.0;
  /// Control against least squares, over coordinates that the set determines (not those of the root), in the
  /// frames in which it does.
  double angle_rms_rad = 0.0, angle_max_rad = 0.0;
  std::int64_t values = 0,
               determined_values = 0;  ///< of those coordinates: all, and determined in their frame
  double all_angles_rms_rad = 0.0;     ///< over all that the model does not lock
  /// The same coordinates against the simulated subject's own; NaN without one.
  double control_truth_rms_rad = kNaN, least_squares_truth_rms_rad = kNaN;
  /// Values of those coordinates in frames whose every coordinate is determined, which both equations
  /// require, and how many of them lie no farther from least squares, solved apart, than equation 15, and 16,
  /// says; equation 15 as track_markers() follows it to the best fit (TrackResult::goal_error), 0.01 deg for
  /// where that ends.
  std::int64_t bounded = 0, held_15 = 0, held_16 = 0;
  int determined = 0, coordinates = 0;
  int rank_min = 0, rank_max = 0, free_speeds = 0;
  std::int64_t flagged_frames = 0;  ///< not counted in the lines above when any
  double us_per_step = 0.0;
  [[nodiscard]] bool failed() const { return flagged_frames > 0; }
};
/// @param truth  of a simulated subject, on the frames of the recording; null: there is none
[[nodiscard]] ControlComparison compare(const model::Model& model, const motion::TrackResult& control,
                                        const motion::IkResult& least_squares, std::string set,
                                        const data::JointMotion* truth = nullptr);

/// One coordinate row of the first frame of a motion, for run_control().
[[nodiscard]] Eigen::VectorXd first_pose(const data::JointMotion& motion);

}  // namespace kinemark::studies

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control: a simulated body whose torques make its markers follow the measured ones, at any
// number of priority levels, so that joint angles and torques come out together and without inverse
// kinematics (Demircan, Sentis, De Sapio, Khatib 2008). Theory: docs/theory/direct-marker-control.md
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/progress.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track_options.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::motion {

/// What became of one of several levels.
struct LevelAccount {
  double weight = kNaN;       ///< of its squared errors in the sum of all; NaN: a strict level
  double bound_m = kNaN;      ///< of a strict level's error in a frame; NaN: none
  double rms_error_m = kNaN;  ///< to its goals, of all frames
  double max_error_m = 0.0;   ///< RMS of its goals in the worst frame
  std::int64_t beyond = 0;    ///< frames in which it was beyond its bound
  std::int64_t unmet = 0;     ///< those of them in which all levels in one sum did not keep the bound either
  int rows = 0;               ///< numbers that it asks for
  int directions_left = 0;    ///< fewest that the levels above leave to it in any pose looked at; with more
                              ///< rows than these it is a compromise
};

/// Levels that the program proposed, from poses of a first run.
struct LevelProposal {
  std::vector<TrackLevel> levels;  ///< markers that are independent and decoupled, independent ones
                                   ///< that are coupled to these, and all others ("*")
  std::vector<std::vector<double>> smallest;  ///< per level and marker chosen: smallest singular value of its
                                              ///< rows beside those before it, in the worst pose, kg^-1/2
  std::int64_t poses = 0;                     ///< that were looked at
};

/// What became of one task that a level names.
struct TaskAccount {
  std::string text;         ///< as it was asked for
  bool is_angle = false;    ///< errors are in rad; else m
  double rms_error = kNaN;  ///< distance to its goal, of all frames in which it has one; NaN: none
  double max_error = 0.0;   ///< in the worst frame
};

/// What a wanted accuracy led to. Errors are RMS over the angles of joints that the markers determine, for
/// this model: that it has the wrong size shows in no recording.
struct AccuracyChoice {
  double wanted_rad = 0.0;                                 ///< as asked for
  double predicted_rad = 0.0;                              ///< of the choice, for this model
  double noise_sd_m = 0.0;                                 ///< of a sample per axis, as given or found
  double noise_rad = 0.0, lost_rad = 0.0, step_rad = 0.0;  ///< its parts: noise, lost movement, steps
  double cutoff_hz = 0.0;                                  ///< at which noise and lost movement are least
  double step_s = 0.0, omega_rad_s = 0.0;                  ///< the longest step that does, and its gains
  std::string largest, smallest;                 ///< coordinates that are known worst and best (equation 17)
  double largest_rad = 0.0, smallest_rad = 0.0;  ///< how well
};

/// What track_markers() found: the motion, and how well it follows the markers.
struct TrackResult {
  /// q, qd, qdd, tau, marker_error (measured minus model), status; with error bars also q_sd, determined and
  /// q_bound. Status not_converged: the frame was flagged (explosion, restart, goals out of reach).
  data::JointMotion motion;
  data::MarkerFit fit;    ///< loop gaps are not computed
  std::vector<int> rank;  ///< per frame: directions that the levels fix together
  /// Per frame: smallest pivot over all levels, near the smallest singular value of what they fix, kg^-1/2; 0
  /// where they fix nothing. Without error bars NaN where one level fixes everything: not computed.
  std::vector<double> smallest_singular;
  /// F x n, with error bars: the coordinates that the goals ask for, level by level, minus those of the body.
  /// Equation 15, the first order; where the goals are one sum of squares that fixes all coordinates,
  /// followed to its best fit. NaN where not determined, and in frames in which that fit is not found: there
  /// goal_bound stands for it in deviations and bounds.
  Array<double> goal_error;
  /// F x n, with error bars: bound of equation 16 on the distance to the coordinates that the goals ask for,
  /// level by level. It takes goals for exact and knows norms only; motion.q_bound is the bound on the error.
  Array<double> goal_bound;
  /// F x n, with error bars: SD of what the filter of the goals took away from the movement, part of
  /// motion.q_sd; 0 without a filter, NaN where not determined.
  Array<double> filter_sd;
  std::optional<AccuracyChoice> accuracy;  ///< where one was asked for
  std::optional<LevelProposal> proposed;   ///< where levels were to be proposed
  std::vector<LevelAccount> levels;        ///< as asked for; empty where there is one
  std::vector<TaskAccount> tasks;          ///< those that levels name, in their order
  Array<double> level_error;  ///< F x levels: RMS distance to the goals, m; NaN where none is seen
  /// F: strict levels that were followed in one sum of squares, because one had been beyond its bound.
  std::vector<std::uint8_t> relaxed;
  std::int64_t relaxations = 0;                       ///< times that this began
  int free_speeds = 0;                                ///< directions there are: speeds that are not locked
  std::vector<std::string> locked_coordinates;        ///< held at the rest pose because no marker moves them
  std::vector<std::string> undetermined_coordinates;  ///< fixed in less than 95 % of the frames
  double rms_goal_error_m = 0.0, max_goal_error_m = 0.0;  ///< goal (filtered) to model, gaps left out
  std::int64_t flagged_frames = 0;                        ///< frames beyond max_error_m, or not followed
  std::int64_t restarts = 0;                              ///< times that the body was set anew to its markers
  /// Poses that a solver of inverse kinematics was asked for after the first one: to settle, to set the body
  /// anew, to judge samples of frames in which markers come, go or stand out.
  std::int64_t solves = 0;
  double step_s = 0.0;         ///< as used
  std::int64_t steps = 0;      ///< of the controller
  double solve_seconds = 0.0;  ///< wall time of the steps alone, without start and error bars
};

/// Track every frame of the time range.
///
/// Markers are matched by name as by solve_ik(). Errors (one sentence): options out of range, gains that are
/// unstable for the step, no marker in common, or none seen in the time range, a level without tasks, a
/// marker named twice or fixed to the ground, coordinates without mass behind them. Goals that cannot be
/// reached are not errors: the frames are flagged. About 100 us per step for a whole body with one level;
/// steps allocate nothing.
[[nodiscard]] Result<TrackResult> track_markers(const model::Model& model, const data::Trajectories& markers,
                                                const TrackOptions& options = {},
                                                const Progress& progress = {});

/// The goals that track_markers() pursues, at the frames of the recording: filtered, gaps left as they are.
/// Covariances and methods are not carried over.
[[nodiscard]] Result<data::Trajectories> control_goals(const data::Trajectories& markers,
                                                       const TrackOptions& options = {});

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/stages/motion/control/task.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion {

/// A goal that a name describes: made of the recorded markers, or a value that is held.
struct NamedTask {
  /// What is to follow a goal.
  enum class Kind : std::uint8_t {
    orientation,  ///< of a body: that of a rigid body fitted to its own markers in each frame
    coordinate,   ///< held at a value
    distance,     ///< of two markers, as recorded
    mass_centre   ///< of the whole body along an axis of the world, held at a value
  };
  /// Unit in which the value was given.
  enum class Unit : std::uint8_t {
    plain,  ///< none: rad or m, as the coordinate has it
    angle,  ///< deg or rad
    length  ///< m or mm
  };
  Kind kind = Kind::orientation;  ///< what it is
  std::string name;               ///< body; coordinate; two markers, "A-B"; x, y or z
  double value = 0.0;             ///< rad or m; NaN: that of the rest pose
  Unit unit = Unit::plain;        ///< of the value
  std::string text;               ///< as it was written
};

/// Markers and tasks of one level. Levels are parts of one sum of squares, each with a weight of its own, or
/// strict priorities in descending order: a lower level never disturbs a higher one.
struct TrackLevel {
  std::vector<std::string> markers;          ///< names in the model; "*": all that no level names
  std::vector<std::shared_ptr<Task>> tasks;  ///< goals that are not points, see tasks.h
  std::vector<NamedTask> named;              ///< the same by their names
  double weight = 0.0;  ///< > 0, of squared errors beside those of other levels; 0 in all levels: found

  /// A level from its text: names of markers and tasks, separated by commas. Tasks are orientation:BODY,
  /// coordinate:NAME=VALUE (a number in rad or m, with a unit deg, rad, m or mm, or `rest`),
  /// distance:MARKER-MARKER and com:AXIS=VALUE.
  static Result<TrackLevel> parse(std::string_view text);
  /// Its tasks and then its markers, as a text names them; tasks that only C++ knows are not among them.
  [[nodiscard]] std::vector<std::string> names() const;
};

/// Treatment of coordinates that no tracked marker moves by more than 1 cm per rad (per m: 1 cm).
enum class LockMode : std::uint8_t {
  automatic,  ///< they are held at the rest pose
  off         ///< they are left to the posture task
};

/// Options of track_markers().
struct TrackOptions {
  std::vector<TrackLevel> levels;  ///< empty: one level of all markers
  /// Levels are strict priorities; else each level's squared errors are weighted by 1 / variance of its
  /// markers, as a first run with equal weights finds it. Where that is not known, and in a live stream,
  /// each level weighs four times as much as the next.
  bool strict = false;
  /// In place of `levels`: such as the body allows, see LevelProposal. Not for a live stream.
  bool propose_levels = false;
  double level_bound_m = 0.0;  ///< of a strict level's RMS distance to its goals; 0: from a first run
  std::vector<MarkerWeight> marker_weights;  ///< within a level; markers not listed have 1, 0 leaves out

  double omega_rad_s = 100.0;  ///< > 0; kp = omega^2, kd = 2 omega
  double kp = 0.0, kd = 0.0;   ///< 1/s^2 and 1/s; both > 0: used in place of omega
  double step_s =
      0.0;  ///< largest step; a frame is cut into equal ones. 0: the largest with omega step <= 0.5
  double accuracy_rad = 0.0;  ///< > 0: RMS over angles of joints that is asked for; cut-off, step and omega
                              ///< follow from a first run, or the run is refused. Not for a live stream
  bool settle = false;        ///< one level of markers: at every frame a solver of inverse kinematics removes
                        ///< what is left of the gradient of the marker errors, so that the frame's pose is
                        ///< the best fit, also where markers contradict one another
  double damping = 0.1;      ///< >= 0, kg^-1/2: directions that hardly move the markers are slowed
  double truncation = 1e-4;  ///< > 0, of a level's strongest direction: below, left to lower levels
  bool feed_forward = true;  ///< velocity and acceleration of the goals are used
  double cutoff_hz = 6.0;    ///< of the goals, zero phase, -3 dB; 0: goals are the samples; or >= 0.12
  double lookahead_s =
      0.0;              ///< half width of that filter; 0: 1.2 / cutoff. It is the delay of the online tracker
  double fade_s = 0.1;  ///< > 0; a marker's weight grows and shrinks over this time beside its gaps
  const data::Derivatives* derivatives = nullptr;  ///< velocity and acceleration of the samples, used in
                                                   ///< place of the filter; not for the live tracker

  double posture_kp = 100.0, posture_kd = 20.0;  ///< of the null space of all levels, root included; >= 0
  std::vector<CoordinateTask> rest_pose;  ///< name and value; others: the model's default, roots: the start
  bool limits = true;                     ///< clamped coordinates stay in their range
  LockMode lock = LockMode::automatic;    ///< which coordinates are held besides
  std::vector<std::string> locked;        ///< coordinates held at the rest pose besides those the model locks

  bool judge_samples = true;  ///< leave out samples that neither the model nor the frames beside explain

  double first_time_s = -1e300;    ///< track only frames in [first_time_s, last_time_s]
  double last_time_s = 1e300;      ///< both ends included
  double max_error_m = 0.3;        ///< a frame with a larger RMS distance to its goals is flagged
  double max_speed = 1e3;          ///< rad/s, norm of all speeds: beyond, flagged and started anew
  bool error_bars = true;          ///< compute q_sd, determined and q_bound
  double marker_noise_sd_m = 0.0;  ///< of a sample per axis; 0: estimated
  std::uint64_t seed = 1;          ///< of the random starts of the first pose
  int starts = 60;                 ///< poses tried for the first frame at most
  int threads = 1;                 ///< for the error bars; 0: all cores. Any number gives the same bits

  /// Ranges hold, no number is NaN, no level is empty.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::motion

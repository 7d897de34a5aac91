// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What follows from a motion of a model: how coordinates, bodies and points move, torques, each number with
// its standard deviation; and measures of joints and of the body, each with its interval.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/analysis/body/body_series.h"
#include "kinemark/stages/motion/dynamics/body_motion.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// What errors and sentences call the parts of a GivenMotion.
struct MotionNames {
  std::string motion = "the motion";                                    ///< in front of errors that it causes
  std::string forces = "the forces";                                    ///< likewise
  std::string no_deviations = "the motion has no standard deviations";  ///< begins the sentence that says so
};

/// A motion of a model, and the forces on the body: F frames, n coordinates.
struct GivenMotion {
  /// q of every coordinate of the model; q_sd where deviations are known, NaN where they are not;
  /// `determined` where something says so. Rates and torques that it has are found anew. Coupled coordinates
  /// are made to follow those that drive them.
  data::JointMotion motion;
  Array<std::uint8_t> is_filled =
      {};  ///< F x n, 1: nobody measured it, and q is a number in between; or empty
  std::optional<data::Wrenches> forces = {};  ///< on the body, in the model's axes, on a clock of their own
  MotionNames names = {};                     ///< what errors and sentences call them
  std::vector<std::string> contradicted =
      {};  ///< what of it contradicts what else is known, one sentence each: misses the gate `contradictions`
};

/// What is asked of dynamics(): bodies and points to follow, by their indices in the model's description, and
/// the rest.
struct DynamicsOptions : motion::BodyMotionOptions {
  bool mass_centre = true;  ///< that of the whole body is followed, also without bodies and points
  bool torques = false;     ///< inverse dynamics without forces too; with forces it is done always
  double cutoff_hz = 0.0;   ///< low-pass of the coordinates beforehand (Butterworth, third order, both ways),
                            ///< after which no deviations are known; 0: none
};

/// A motion, and what follows from it.
struct DynamicsFound {
  data::JointMotion motion;  ///< with rates and, where asked for, torques; NaN where nobody measured it
  /// F x n each, one standard deviation of q, qd and qdd, NaN where not determined; empty without error bars.
  std::array<Array<double>, 3> sd;
  std::optional<motion::BodyMotion> bodies;  ///< bodies, mass centre and points; none: nothing is followed
  std::vector<std::pair<std::string, std::string>>
      facts;        ///< how rates and deviations were found; what is known of the torques
  Remarks remarks;  ///< of the low-pass and of the torques
};

/// Rates of coordinates, where bodies and points are and how they move, torques. Each coordinate is smoothed
/// by itself, with a bandwidth that follows from its own likelihood; q stays as it is. Deviations are of
/// first order, and errors of different coordinates are taken as independent (motion::body_motion()).
///
/// Code::bad_input for a motion that is not of the model, whose frames were made between measured ones
/// (unless it is low-passed), and as motion::estimate_rates(); Code::usage for a cut-off that is none or
/// beyond half the rate. Torques fail as check_forces() and motion::inverse_dynamics(). About 1 ms a frame of
/// a whole body.
[[nodiscard]] Result<DynamicsFound> dynamics(const model::Model& model, const GivenMotion& given,
                                             const DynamicsOptions& options = {});

/// What is asked of measure_motion().
struct MotionMeasureOptions {
  std::vector<std::string> measures = {};  ///< ids (`kinemark dynamics --list`); empty: those that apply
  std::vector<std::string> select =
      {};  ///< coordinates; * is any text, ? any letter; empty: all that move by themselves
  std::vector<std::string> couple = {};  ///< "hip_flexion_r,knee_angle_r": coordinates whose coupling counts
  std::vector<analysis::BodyStretch> stretches = {};  ///< empty: the whole motion
  bool torques = false;      ///< moments, power and work without forces too; with forces always
  bool normalized = false;   ///< kinetics per mass, momentum over mass, speed and height
  double cutoff_hz = 0.0;    ///< as DynamicsOptions::cutoff_hz: no intervals are known then; 0: none
  std::int64_t refits = 99;  ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double level = 0.95;       ///< of the intervals
  std::uint64_t seed = 1;    ///< of the refits
  int threads = 1;           ///< 0: all cores. Any number gives the same bits.
};

/// A motion that was measured.
struct MotionMeasured {
  std::vector<data::Measure> measures;  ///< by stretch: coordinates, pairs, the body
  data::JointMotion motion;             ///< with rates and, where they were found, torques
  analysis::BodyRecord record;  ///< which coordinates move, and where they and their torques are determined
  std::vector<std::string> left_out;  ///< what could not be measured of what was asked for, a sentence each
  Remarks remarks;                    ///< of the model, the torques, the low-pass, the deviations
};

/// Ranges, extremes, rates, power and work of joints, coupling of two, mass centre, stability and angular
/// momentum of the body; each without the bias of noise and with an interval.
///
/// Feet are the bodies whose names hold "calcn", "foot" or "toes", their sides those of the names, their
/// outline the model's markers on them. They stand where a plate sees them and where they rest on the ground.
///
/// Code::usage for a measure or a coordinate that is none; Code::bad_input where nothing of what is asked for
/// can be measured, and as analysis::measure_body(); else fails as dynamics(). Time: refits x inverse
/// dynamics.
[[nodiscard]] Result<MotionMeasured> measure_motion(const model::Model& model, const GivenMotion& given,
                                                    const MotionMeasureOptions& options = {});

}  // namespace kinemark::workflow

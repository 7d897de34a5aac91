// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics from the orientations of inertial sensors, alone or beside markers: joint angles whose
// model bodies turn as the sensors on them did. Theory: docs/theory/orientations.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/orientations.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::motion {

/// Which body carries a sensor.
struct SensorBody {
  std::string sensor;  ///< as the recording names it
  std::string body;    ///< of the model
};

/// A sensor that is on its body already, as a model says.
struct PlacedSensor {
  std::string sensor;                                              ///< as the recording names it
  std::string body;                                                ///< of the model
  Eigen::Matrix3d body_from_sensor = Eigen::Matrix3d::Identity();  ///< rotation
};

/// The axis of a sensor that points where the body faces, in the pose that places the sensors.
struct FacingAxis {
  std::string sensor;                               ///< as the recording names it
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< in the sensor
};

/// Options of solve_orientations().
struct OrientationOptions {
  std::vector<PlacedSensor> placed;  ///< where there are any, only these are used, and no pose is asked for
  std::vector<SensorBody> sensors;   ///< others are matched by name: "tibia_r_imu", or the body's own name
  Eigen::Vector3d up_in_world = Eigen::Vector3d::Zero();  ///< of the sensors' world; 0: as the model's
  std::optional<FacingAxis> facing;  ///< gives the heading; none: it is estimated from the motion
  double noise_sd_rad = 0.0;         ///< of an orientation about each axis; 0: estimated from the residuals
  bool judge_samples = true;         ///< leave out samples of single sensors that are turned
  bool limits = true;                ///< clamped coordinates stay in their range
  bool error_bars = true;            ///< compute q_sd and determined
  double first_time_s = -1e300;      ///< solve only frames in [first_time_s, last_time_s]
  double last_time_s = 1e300;        ///< both ends included
  std::uint64_t seed = 1;            ///< of the random starts of the first frame
  int threads = 1;                   ///< for the error bars; 0: all cores. Any number gives the same bits.

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// What says how a sensor stands on its body.
enum class SensorPlacement : std::uint8_t {
  pose,     ///< a recording of the model's default pose
  model,    ///< a frame of the model
  markers,  ///< the frames in which markers determine how its body is turned
};

/// One sensor that took part.
struct FittedSensor {
  std::string name;                                                ///< in the recording
  std::string body;                                                ///< of the model, that carries it
  Eigen::Matrix3d body_from_sensor = Eigen::Matrix3d::Identity();  ///< how it stands there
  SensorPlacement placed_by = SensorPlacement::pose;               ///< what says so
  double seen = 0.0;                                               ///< share of the solved frames, 0 to 1
  double rms_rad = kNaN;  ///< angle between measured and model; NaN when never seen
  double max_rad = 0.0;   ///< largest such angle
};

/// How the sensors' heading, about the vertical, was found.
enum class HeadingSource : std::uint8_t {
  motion,   ///< estimated: the one with which the joints' axes explain the motion best
  model,    ///< none is needed: the model says how sensors stand on bodies; angles are those of the sensors'
            ///< world
  facing,   ///< the axis of a sensor faces where the model faces
  markers,  ///< estimated: sensors turn as the markers of their bodies
};

/// Samples of one sensor that were left out: turned against those before and after.
struct RejectedOrientations {
  std::string sensor;                            ///< in the recording
  bool in_pose = false;                          ///< of the recording of the pose
  std::int64_t first_frame = 0, last_frame = 0;  ///< as that recording counts frames, both ends included
  double first_s = 0.0, last_s = 0.0;            ///< on its clock
  double angle_rad = 0.0;                        ///< largest turn

  /// How many samples.
  [[nodiscard]] std::int64_t samples() const { return last_frame - first_frame + 1; }
};

/// How orientations and a model fit.
struct OrientationFit {
  std::int64_t first_frame = 0;         ///< index in the recording of the motion's frame 0
  std::vector<FittedSensor> sensors;    ///< those used
  std::vector<std::string> left_out;    ///< sensors that no body carries
  std::vector<std::string> never_seen;  ///< sensors on bodies that no solved frame has
  std::vector<std::string>
      unplaced;  ///< on bodies, but nothing says how they stand there; beside markers only
  std::vector<RejectedOrientations> rejected;  ///< samples left out, of the sensors used
  double pose_drift_rad = 0.0;  ///< largest turn of a sensor within the pose, or the recording's first 0.5 s
  double heading_rad = 0.0;     ///< turn about the model's vertical of the sensors' world
  double heading_sd_rad = 0.0;  ///< one standard deviation; 0 where it is given
  HeadingSource heading_source = HeadingSource::motion;  ///< how it was found
  double noise_sd_rad = kNaN;  ///< of an orientation about each axis; NaN: neither given nor in the residuals
  double rms_rad = kNaN;       ///< angle between measured and model, all sensors and frames
  double max_rad = 0.0;        ///< largest such angle
  std::vector<std::string> at_default;  ///< coordinates that turn nothing; without markers
};

/// What solve_orientations() found.
struct OrientationResult {
  data::JointMotion motion;    ///< solved frames only; lengths stay at their defaults, not determined
  Array<double> error_rad;     ///< F x S, angle between measured and model; NaN where a sensor is missing
  OrientationFit fit;          ///< sensors, heading, noise
  double solve_seconds = 0.0;  ///< wall time
};

/// Joint angles from sensors whose place on the bodies follows from a pose: in it the model stands in its
/// default pose, facing along its x axis, and each sensor keeps on its body the orientation that it has
/// there.
///
/// Orientations say nothing of positions: every coordinate that only moves stays at its default, not
/// determined. The cost of a frame is sum over sensors of |R - R_measured|^2 (Frobenius), which is twice the
/// squared angle where it is small; it is solved exactly as that of markers by a model without lengths, whose
/// sensors are three points at the tips of their axes. Error bars hold the noise of the orientations (given,
/// or pooled over sensors from the residuals) and of the heading. A pose that is not the model's default adds
/// the same angles to all frames, which no residual shows. Samples of a sensor that is turned against the
/// frames beside, for up to ten of them, are left out first.
/// @param pose  sensors in the default pose, all frames are averaged; null: the first frame in which the
///              recording has all of its sensors
///
/// Code::bad_input where no body carries a sensor, a sensor is missing in the pose, no frame lies in the time
/// range, or the heading is neither given nor determined by the motion. About 50 us a frame and sensor set.
/// Source: OpenSense (Al Borno et al. 2022, J. NeuroEng. Rehabil. 19:22), placing as its IMUPlacer.
[[nodiscard]] Result<OrientationResult> solve_orientations(const model::Model& model,
                                                           const data::Orientations& recording,
                                                           const data::Orientations* pose,
                                                           const OrientationOptions& options = {},
                                                           const Progress& progress = {});

/// What solve_mixed() found.
struct MixedResult {
  IkResult ik;              ///< motion and fit of the markers
  Array<double> error_rad;  ///< F x S, angle between measured and model; NaN where a sensor is missing
  OrientationFit fit;       ///< sensors, heading, noise; its first_frame is that of the markers
};

/// Joint angles from markers and sensors together, each by its own noise, on the frames of the markers. Both
/// have the same clock: orientations are interpolated on it, frames beyond their span have markers alone.
///
/// Markers alone are solved and judged first. Sensors on bodies that the markers then fix to 2 deg in 10
/// frames or more are placed by these frames, others by the pose; without a pose 0.1 rad will do; the model's
/// frames take precedence over both (options.placed). The heading is that under which sensors turn as the
/// markers of their bodies, unless options.facing gives it.
/// @param pose  sensors in the default pose; null: only markers or the model place sensors
///
/// The loss is square. Times of `ik` count, those of `options` do not. Fails as solve_ik(); Code::bad_input
/// where no body carries a sensor, nothing places one, the two have no time in common, or the heading is not
/// determined. Costs about three times solve_ik().
[[nodiscard]] Result<MixedResult> solve_mixed(const model::Model& model, const data::Trajectories& markers,
                                              const data::Orientations& recording,
                                              const data::Orientations* pose, const IkOptions& ik,
                                              const OrientationOptions& options = {},
                                              const Progress& progress = {});

}  // namespace kinemark::motion

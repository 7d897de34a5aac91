// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint angles of a recording of markers, by one of two estimators, with torques where they are asked for.
#pragma once

#include <cstdint>
#include <optional>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/image_tracks.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"
#include "kinemark/workflow/motion/gates.h"
#include "kinemark/workflow/motion/torques.h"
#include "kinemark/workflow/prepare/axes.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// How coordinates are found: frame by frame, or over the whole recording at once.
enum class Estimator : std::uint8_t { least_squares, smoother };

/// Inertial sensors beside the markers, on the same clock.
struct SensorInputs {
  data::Orientations recording;            ///< orientations
  std::optional<data::Orientations> pose;  ///< the same sensors in the model's default pose
  motion::OrientationOptions options;  ///< of the sensors; times, limits, seed and threads are those of `ik`
};

/// What is asked of ik().
struct IkOptions {
  motion::IkOptions ik;                            ///< of the least squares, from which the smoother starts
  Estimator estimator = Estimator::least_squares;  ///< which estimator
  bool torques = false;  ///< torques as well, with the forces of the recording's plates
  MarkerBounds bounds;   ///< of the gates
  const data::ImageTracks* images =
      nullptr;                            ///< seen besides the markers, on their frames; the smoother alone
  const SensorInputs* sensors = nullptr;  ///< besides the markers; the least squares alone
  Progress progress;                      ///< frames
};

/// How sensors beside the markers took part.
struct SensorsFound {
  Array<double> error_rad;     ///< F x S, angle between measured and model; NaN where a sensor is missing
  motion::OrientationFit fit;  ///< sensors, heading, noise
};

/// A motion that was solved from markers.
struct IkFound {
  motion::IkResult result;  ///< motion and fit, the motion with torques where they were asked for
  TorqueAccount torques;    ///< empty unless they were asked for
  data::Trajectories used;  ///< markers as they were used, without what was left out, on the motion's frames
  std::optional<SensorsFound> sensors;  ///< where there were any
  Remarks remarks;  ///< of the fit, of the torques; gates on distances, frames, samples, loops
};

/// A recording and its forces are turned into the axes of a model: how that was done. Without a choice, a
/// vertical that is found and lies 45 deg or more off the model's is Code::bad_input; so are forces that do
/// not push the body up, unless the axes were chosen, which is a note of the recording then. Fails as
/// settle_axes() and check_forces().
/// @param name  of the recording, in front of what is said of it
[[nodiscard]] Result<Axes> bring_into_axes(const AxesChoice& choice, const std::string& name,
                                           data::Recording& recording, const model::Model& model);

/// Joint angles, each with its standard deviation and a flag that says whether the visible markers fix it.
/// The recording is in the model's axes (bring_into_axes()). The smoother gives rates as well.
///
/// Code::usage for images with least squares, and for sensors with the smoother; else fails as
/// motion::solve_ik(), motion::solve_mixed(), motion::smooth_motion() and add_torques().
[[nodiscard]] Result<IkFound> ik(const model::Model& model, const data::Recording& recording,
                                 const IkOptions& options = {});

}  // namespace kinemark::workflow

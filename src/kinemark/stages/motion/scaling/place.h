// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion {

/// Options of place_markers().
struct PlaceOptions {
  IkOptions ik;                    ///< marker weights, coordinate tasks, and the time range that is averaged
  std::vector<std::string> fixed;  ///< markers that stay where the model has them
  double max_marker_movement_m = -1;  ///< refuse a trial whose markers move more within the range; < 0: any
};

/// A marker of the model before and after it was placed.
struct PlacedMarker {
  std::string name, body;  ///< in the model
  Eigen::Vector3d before_in_body = Eigen::Vector3d::Zero(), after_in_body = Eigen::Vector3d::Zero();  ///< m
  double error_m = 0.0;  ///< distance of the measured to the model's marker in the pose that was found
  bool fixed = false;    ///< it was not to be moved
};

/// A model whose markers sit where the static trial shows them.
struct PlaceResult {
  data::ModelDescription model;       ///< with the new marker positions
  std::vector<PlacedMarker> markers;  ///< those that model and trial share
  Eigen::VectorXd pose;               ///< coordinates of the static pose, in the model's order
  double rms_m = 0.0;                 ///< of the markers that took part in finding the pose
  std::vector<std::string> unseen;    ///< markers of the model that the trial does not show; they stay
};

/// Move the markers of a scaled model to their positions in the static trial (OpenSim's MarkerPlacer): the
/// trial is averaged, its pose found by inverse kinematics, and every marker that is not fixed moved to its
/// measured position. Fails for what solve_ik() refuses, and when a marker moves more than allowed.
[[nodiscard]] Result<PlaceResult> place_markers(const data::ModelDescription& model,
                                                const data::Trajectories& static_trial,
                                                const PlaceOptions& options);

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which way is up in a recording, as its force plates, the body in it, or its file tell.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "kinemark/data/trial.h"
#include "kinemark/model/model.h"

namespace kinemark::workflow {

/// An axis of the laboratory that points up, and who says so.
struct Vertical {
  Eigen::Vector3d up;  ///< x, y or z, or one of them negated
  std::string from;    ///< "the force plates", for a sentence
};

/// Against gravity, length 1; none where the model has no gravity.
[[nodiscard]] std::optional<Eigen::Vector3d> up_of(const model::Model& model);

/// The axis across all plates, towards the markers. None where there are no plates with corners, where they
/// differ or lie askew by more than 10 deg.
[[nodiscard]] std::optional<Vertical> vertical_of_plates(const data::Trial& trial);

/// Where the model's default posture, which is taken as upright, has to be turned to meet the markers best.
/// None unless that is sure: markers of three bodies that reach over 0.8 m of the model's height, the same
/// axis within 40 deg in 19 of 20 frames, of 50 or fewer frames that are looked at.
[[nodiscard]] std::optional<Vertical> vertical_of_body(const data::Trajectories& markers,
                                                       const model::Model& model);

/// What the recording says goes up the screen (POINT:Y_SCREEN of a C3D file). None where it says nothing, nor
/// for an axis that is negated: files that say "-Z" stand on plates with z up.
[[nodiscard]] std::optional<Vertical> vertical_of_screen(const data::Trial& trial);

/// The first that tells: plates, body, file.
[[nodiscard]] std::optional<Vertical> find_vertical(const data::Trial& trial, const model::Model& model);

}  // namespace kinemark::workflow

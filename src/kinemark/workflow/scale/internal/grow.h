// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Steps that move the model on, from markers alone.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/workflow/scale/scale.h"

namespace kinemark::workflow {

/// One factor for the whole model, from distances between markers of one body.
Status take_overall_size(const data::Trajectories& markers, ScaleFound& found);

/// Sizes, places of markers and of found.joints at which inverse kinematics fits best. The bodies' own sizes
/// carry their mass centres and inertias along; masses follow the volume.
Result<motion::AdaptResult> adapt_to(const data::Trajectories& markers, const ScaleMethod& method,
                                     const motion::AdaptOptions& options, const Progress& progress,
                                     ScaleFound& found);

/// The mass of the whole body, where one is given (above 0).
Status weigh(double mass_kg, bool dempster, data::ModelDescription& model);

/// Lengths of muscles follow the bodies that they run over; what of them is not exact is said.
/// @param before  the model that the paths belong to
Status scale_muscles(const data::ModelDescription& before, const ScaleInputs& inputs, ScaleFound& found);

}  // namespace kinemark::workflow

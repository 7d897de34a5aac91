// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/stages/motion/scaling/place.h"
#include "kinemark/stages/motion/scaling/scale.h"

namespace kinemark::pipeline {

/// The options of scale_model() that a ScaleTool file sets; parts that do not apply are left out.
[[nodiscard]] motion::ScaleOptions scale_options(const io::ScaleSetup& setup);

/// The options of place_markers() that it sets. `fixed`: markers of its set that stay. Tasks of markers that
/// the model lacks are passed over, as OpenSim does; tasks of unknown coordinates, and values that the
/// coordinate file does not hold, are errors.
[[nodiscard]] Result<motion::PlaceOptions> place_options(const io::ScaleSetup& setup,
                                                         const std::vector<io::MarkerOfSet>& set,
                                                         const data::ModelDescription& model);

}  // namespace kinemark::pipeline

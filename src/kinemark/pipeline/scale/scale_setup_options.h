// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/stages/motion/scaling/place.h"

namespace kinemark::pipeline {

/// The options of place_markers() that a ScaleTool file sets. `fixed`: markers of its set that stay. Tasks of
/// markers that the model lacks are passed over, as OpenSim does; tasks of unknown coordinates, and values
/// that the coordinate file does not hold, are errors.
[[nodiscard]] Result<motion::PlaceOptions> place_options(const io::ScaleSetup& setup,
                                                         const std::vector<io::MarkerOfSet>& set,
                                                         const data::ModelDescription& model);

}  // namespace kinemark::pipeline

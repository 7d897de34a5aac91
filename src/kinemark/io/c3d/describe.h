// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/header.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// Fill everything of a trial that is not samples: names (unique), clock, analog names and units, events,
/// force plates, maker. Repairs are reported in trial.warnings.
void describe_trial(const C3dHeader& header, const C3dParameters& parameters, const C3dLayout& layout,
                    data::Trial& trial);

}  // namespace kinemark::io

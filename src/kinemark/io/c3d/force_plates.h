// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// The plates in use, of the group FORCE_PLATFORM, whose type and analog channels are valid; the others, and
/// implausible geometry, are reported in `warnings`.
[[nodiscard]] std::vector<data::ForcePlate> find_force_plates(const C3dParameters& parameters,
                                                              const C3dLayout& layout,
                                                              std::vector<std::string>& warnings);

/// First and last time on the clock of the markers of the frames that FORCE_PLATFORM:ZERO names; the first
/// after the last where it names none of the file.
[[nodiscard]] std::array<double, 2> unloaded_times(const C3dParameters& parameters, const TimeBase& time,
                                                   std::vector<std::string>& warnings);

}  // namespace kinemark::io

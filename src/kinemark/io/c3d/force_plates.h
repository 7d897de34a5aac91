// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// One plate of the group FORCE_PLATFORM.
struct C3dForcePlate {
  int number = 1;            ///< as the file counts, from 1
  bool sound = true;         ///< corners and origin have plausible values
  int calibration_rows = 0;  ///< of CAL_MATRIX, 0 without
  data::ForcePlate plate;    ///< corners and origin in metres
};

/// The plates in use whose type and analog channels are valid; the others, and implausible geometry, are
/// reported in `warnings`.
[[nodiscard]] std::vector<C3dForcePlate> find_force_plates(const C3dParameters& parameters,
                                                           const C3dLayout& layout,
                                                           std::vector<std::string>& warnings);

}  // namespace kinemark::io

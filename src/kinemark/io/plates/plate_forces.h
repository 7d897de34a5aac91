// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Force plates of a recording as forces on the body. Conventions: docs/formats/c3d.md
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::io {

/// Options of plate_forces().
struct PlateOptions {
  double contact_force_n = 20.0;  ///< a plate that pushes less than this along its normal is empty: no wrench
                                  ///< at all in that frame. 0: everything counts, also a pull.
  bool baseline = true;           ///< subtract the mean over the frames in which nobody loads the plates

  /// contact_force_n is finite and not negative.
  [[nodiscard]] Status check() const;
};

/// Forces of all plates of a recording.
struct PlateForces {
  /// One item per plate, "plate 1" and so on as the file counts, at the rate of the markers and in their
  /// axes: force on the body (N), moment about the centre of pressure (N m, along the plate's normal), centre
  /// of pressure on the plate's surface (m; NaN where the plate is empty). Bodies are left open.
  data::Wrenches wrenches;
  std::vector<std::string> warnings;      ///< irregularities and repairs, one sentence each
  std::vector<std::string> contradicted;  ///< those of them that no force on these plates has
};

/// Forces of the plates of types 1, 2, 3, 4, 6 and 7, from any format that keeps their channels. Each frame
/// gets the mean of the analog samples from half a frame before it to half a frame after it. A force is NaN
/// where a sample was not a number.
///
/// Fails when no plate has forces that can be computed: Code::bad_input. O(samples); memory 48 bytes per
/// frame and plate.
[[nodiscard]] Result<PlateForces> plate_forces(const data::Trial& trial, const PlateOptions& options = {});

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"

namespace kinemark::io::internal {

/// Quaternions as they stand in the rows of a text: R rows, S sensors.
struct QuaternionRows {
  std::vector<std::string> names;                 ///< S
  std::vector<double> time_s;                     ///< R
  Array<double> values;                           ///< R x S x 4, w x y z; NaN: missing
  std::vector<double> rates_hz;                   ///< stated, in order of trust; may be none
  double resolution_s = 0.0;                      ///< place value of the times' last digit
  std::vector<std::string> warnings;              ///< so far
  std::function<std::string(std::size_t)> place;  ///< where a row stands: "line 7"
};

/// Quaternions made unit, on an even clock; a gap in the times is frames without. One of zeros is missing,
/// which a warning says for each sensor.
///
/// Code::bad_input without rows or sensors, for times that are not even, and for a quaternion whose length is
/// off 1 by a tenth.
[[nodiscard]] Result<data::Orientations> settle_quaternions(QuaternionRows rows);

}  // namespace kinemark::io::internal

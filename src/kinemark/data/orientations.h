// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// Orientations of S inertial sensors or segments in F frames.
struct Orientations {
  std::vector<std::string> names;     ///< S, unique, not empty
  TimeBase time;                      ///< F = time.frames
  Array<double> quaternion;           ///< F x S x 4: w x y z, length 1, world_from_sensor; NaN where missing
  std::vector<std::string> warnings;  ///< irregularities of the file, one sentence each

  [[nodiscard]] std::int64_t frames() const { return time.frames; }                            ///< F
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(names.size()); }  ///< S
  /// Whether a sensor has an orientation in a frame.
  [[nodiscard]] bool present(std::int64_t frame, std::int64_t sensor) const;
  /// world_from_sensor where present.
  [[nodiscard]] Eigen::Matrix3d rotation(std::int64_t frame, std::int64_t sensor) const;
  /// Rates and shapes agree, names are unique and not empty, quaternions have length 1 to 1e-6 or are NaN.
  [[nodiscard]] Status validate() const;

 private:
  [[nodiscard]] std::size_t index(std::int64_t frame, std::int64_t sensor) const {
    return 4 * static_cast<std::size_t>(frame * size() + sensor);
  }
};

}  // namespace kinemark::data

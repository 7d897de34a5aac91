// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// What one force plate, handle or cable does to the body, F frames. In the laboratory frame of the markers.
struct Wrench {
  std::string name;      ///< "plate 1"
  std::string body;      ///< of the model, on which it acts; empty: the foot nearest to where it acts
  Array<double> force;   ///< F x 3, N, on the body; NaN where it was not measured
  Array<double> moment;  ///< F x 3, N m, on the body about `point`
  Array<double> point;   ///< F x 3, m, where the force acts; NaN allowed where force and moment are 0
  std::vector<Eigen::Vector3d> corners_in_world = {};  ///< m, of a plate, in turn: four; empty: not known
};

/// What plates, handles and cables do to the body, on one clock.
struct Wrenches {
  TimeBase time;              ///< F = time.frames
  std::vector<Wrench> items;  ///< one a plate, handle or cable

  [[nodiscard]] std::int64_t frames() const { return time.frames; }  ///< F
  /// Shapes agree, and a force that is not 0 has a point.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data

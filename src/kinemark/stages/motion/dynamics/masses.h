// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Masses, mass centres and inertias of a model that no rigid body of its size can have.
#pragma once

#include <string>
#include <vector>

#include "kinemark/model/model.h"

namespace kinemark::motion {

/// One of them.
struct MassFault {
  /// centre and gyration: beyond what the whole model spans; mass: of all bodies, above that of a
  /// ball of water which is twice as wide.
  enum class Kind { negative_moment, triangle, gyration, centre, mass };
  Kind kind = Kind::triangle;
  std::string body;    ///< empty for `mass`
  double size = 0.0;   ///< kg m^2: the least moment, or how far the largest exceeds the other two; m; kg
  double bound = 0.0;  ///< m or kg; 0 for moments
  /// Whether torques and energies can depend on it: what a moment is off by, an inertia too wide, or the mass
  /// times the squared distance of its centre is above 1 % of the largest sound moment. A mass always does.
  bool matters = true;

  [[nodiscard]] std::string sentence() const;
};

/// Faults in the order of the bodies. The principal moments of a rigid body are not negative, and none
/// exceeds the sum of the other two (Goldstein, Classical Mechanics, 5.3), by more than a thousandth. Bodies
/// without mass and inertia are not judged, nor are spans where all points of the model coincide. O(bodies).
[[nodiscard]] std::vector<MassFault> find_mass_faults(const model::Model& model);

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What one step on a plate was: peaks, impulses, rate of loading.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {

/// A plate is loaded over frames [first, first + count).
struct PlateContact {
  std::int64_t first = 0, count = 0;  ///< frames
  bool whole = true;                  ///< begins and ends within the recording, and is known throughout
};

/// Load above 20 N for 0.05 s or more, ended below 10 N.
/// @param load  vertical force, N; NaN where not measured, which ends a contact
[[nodiscard]] std::vector<PlateContact> find_contacts(const Eigen::VectorXd& load, double rate_hz);

/// The two humps of a walking step, N; NaN where the load has one hump only.
struct LoadHumps {
  double first = kNaN;   ///< N
  double valley = kNaN;  ///< the least between them, N
  double second = kNaN;  ///< N
};
/// The largest load before and behind the middle of the contact, and the least between them. NaN all where
/// the least is not below 0.97 of both: running, jumping, standing (Winter 2009, ch. 5).
/// @param load  of one contact, N
[[nodiscard]] LoadHumps load_humps(const Eigen::VectorXd& load);

/// Mean slope from 20 to 80 % of the first peak, N/s: the first hump, or the largest load where there is one.
/// The instants are linear between frames; NaN where the load is above 20 % from the first frame on.
[[nodiscard]] double loading_rate(const Eigen::VectorXd& load, double rate_hz);

/// Time integrals of a force along the direction of travel, N s: of what is against it, and of what is along.
struct BrakingPropulsion {
  double braking = kNaN;     ///< against the travel, N s; <= 0
  double propulsion = kNaN;  ///< along it, N s; >= 0
};
/// @param along  force along the direction of travel in a contact, N
[[nodiscard]] BrakingPropulsion braking_propulsion(const Eigen::VectorXd& along, double rate_hz);

/// Direction in which the centre of pressure runs under a step: from its mean over the first third of the
/// contact, weighted by load, to that over the last; length 1, or 0 where it moves by less than 20 mm.
/// @param x     n x 3, m; not read where load is 0
/// @param load  n, N
[[nodiscard]] Eigen::Vector3d direction_of_travel(const Eigen::MatrixX3d& x, const Eigen::VectorXd& load);

}  // namespace kinemark::analysis

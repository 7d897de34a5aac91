// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How large a body is by its markers' names alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion {

/// The size that pairs of markers on one segment tell, whatever the posture.
struct BodySize {
  double factor = 1.0;     ///< beside a man of 1.75 m: median over the pairs
  std::int64_t pairs = 0;  ///< that were compared
  std::string one, other;  ///< markers of the pair in the middle
  double apart_m = 0.0;    ///< their median distance

  /// Whether nobody is so large or small: below 0.2 or above 2. People from birth on have 0.28 to 1.56.
  [[nodiscard]] bool is_nobodys() const { return !(factor >= 0.2 && factor <= 2.0); }
  /// "markers on one segment lie 0.1 times as far apart as a man's (14 pairs, ...): ..."
  [[nodiscard]] std::string sentence() const;
};

/// Pairs of the body's markers on one segment that are expected 80 mm apart or more, each with its median
/// distance in at most 25 evenly picked frames. Nothing with fewer than four such pairs. Well below 1 ms.
[[nodiscard]] std::optional<BodySize> size_of_body(const StandingBody& body,
                                                   const data::Trajectories& recording);

}  // namespace kinemark::motion

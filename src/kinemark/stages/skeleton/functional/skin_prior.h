// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is known of skin before a recording is seen.
#pragma once

#include "kinemark/core/result.h"

namespace kinemark::skeleton {

/// How far a segment's markers slide as one body, in proportion to how far each slides by itself. The latter
/// shows in their shape, the former leaves little or no trace. On thighs and shanks half of the energy
/// (Grimpampi et al. 2014, IEEE Trans Biomed Eng 61:362) to 80 % of it (Barre et al. 2013, ibid. 60:3131)
/// moves the markers as one body: 0.4 to 1.1 times the own slide for translation and turn. People differ by a
/// factor of two.
struct SkinPrior {
  double ball = 1.0;          ///< median of common over own slide, of a ball joint
  double hinge = 1.4;         ///< the same of a hinge
  double ball_factor = 1.6;   ///< one SD of its logarithm, as a factor, of a ball joint
  double hinge_factor = 2.0;  ///< the same of a hinge
  double anywhere = 1e-3;     ///< probability that the common slide has nothing to do with the own one
  /// Skin is no linear and quadratic function of the posture: what is left over, as a share of the slide.
  double misfit = 0.3;

  /// More than 0 and finite; factors beyond 1, probability below 1.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::skeleton

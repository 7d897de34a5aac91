// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is known of skin before a recording is seen.
#pragma once

#include "kinemark/core/result.h"

namespace kinemark::skeleton {

/// Skin of the thigh and shank against bone, as published. With bone pins, knee rotations were wrong by 4.4
/// deg and places by 13 mm on average in walking, by 13.1 deg and 16 mm in cutting (Benoit et al. 2006, Gait
/// & Posture 24:152); with fluoroscopy a thigh's markers turn as one body by some 10 deg and shift by 18 mm,
/// a shank's by 7 deg and 17 mm (PubMed Central PMC8631460), all while a knee bends by some 60 deg.
struct SkinPrior {
  /// SD of the turn of one segment's markers against the other's about each axis across a hinge, per rad of
  /// the hinge's angle: 6 deg in 60. The figures above lie between 0.07 and 0.2.
  double turn = 0.1;
  /// How much it weighs beside what a recording's own markers show: as much as this many numbers. Skin slides
  /// by 5 to 20 mm from one person, movement and marker set to the next: of another's skin one number is
  /// known.
  double turn_weight = 1.0;
  /// Median of the slide of a hinge's place on an axis at one SD of its angle, m: 15 mm from one end of a
  /// movement to the other have an SD of 5 mm.
  double slide_m = 0.005;

  /// More than 0 and finite.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::skeleton

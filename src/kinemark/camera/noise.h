// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/rig.h"

namespace kinemark::camera {

inline constexpr double kElementaryCharge = 1.602e-19;  ///< C, rounded as in the reference values
inline constexpr double kBoltzmann = 1.380649e-23;      ///< J/K

/// White current noise of a channel in the dark, A^2/Hz: thermal noise of the sheet and of the feedback
/// resistor, the amplifier's voltage noise over the sheet, and shot noise of the room's light.
[[nodiscard]] double current_noise_a2_hz(const data::Electronics& electronics);

/// Noise bandwidth of the amplifier's pole, Hz: 1 / (4 tau).
[[nodiscard]] double noise_bandwidth_hz(const data::Electronics& electronics);

/// Standard deviation of the amplifier's output for a signal of that many counts, in counts: dark noise and
/// the signal's own shot noise.
[[nodiscard]] double amplifier_noise_counts(const data::Electronics& electronics, double counts);

/// Variance of one conversion, counts^2: amplifier, converter and rounding.
[[nodiscard]] double conversion_variance(const data::Electronics& electronics, double counts);

}  // namespace kinemark::camera

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Noise whose power falls with a power of the frequency, as 1/f noise does.
#pragma once

#include "kinemark/math/noise_model.h"

namespace kinemark::math {

/// Such noise as it was fitted. Frequencies are cycles per sample.
struct PowerNoise {
  double power = 0.0;     ///< of its spectrum at `lowest`
  double exponent = 0.0;  ///< of f^-exponent, 0 to 2.2
  double floor = 0.0;     ///< variance of white noise on top
  double lowest = 0.0;    ///< from which it was fitted
  double corner = 0.0;    ///< below which there is no more of it
};

/// The correlated and white noise that has its power at the lowest frequency, at 0.4 Hz, and, with more white
/// noise, at three times the lowest frequency.
[[nodiscard]] NoiseModel like_power(const PowerNoise& noise, double rate_hz);

}  // namespace kinemark::math

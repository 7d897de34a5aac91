// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinemark::data {

/// The filter that one marker went through.
struct FilterUsed {
  std::string method;  ///< "kalman", "butterworth", "gcv", "savgol", "classic", "none"
  int order = 0;       ///< of the method: integrations of the Wiener process, half order of the spline, poles
  double cutoff_hz = 0.0;   ///< -3 dB of the whole filter; NaN where it has none
  double noise_sd_m = 0.0;  ///< per axis, of the samples that went in; NaN when unknown
};

}  // namespace kinemark::data

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/noise.h"

#include <cmath>
#include <numbers>

namespace kinemark::camera {

double current_noise_a2_hz(const data::Electronics& e) {
  const double thermal = 4.0 * kBoltzmann * e.temperature_k;
  const double amplifier = 2.0 * e.amplifier_noise_v_rthz / e.interelectrode_ohm;
  return thermal / e.interelectrode_ohm + amplifier * amplifier + thermal / e.feedback_ohm +
         2.0 * kElementaryCharge * (e.ambient_a / 4.0);
}

double noise_bandwidth_hz(const data::Electronics& e) {
  return std::numbers::pi / 2.0 / (2.0 * std::numbers::pi * e.time_constant_s);
}

double amplifier_noise_counts(const data::Electronics& e, double counts) {
  const double shot = 2.0 * kElementaryCharge * std::abs(counts) * e.count_a();
  return std::sqrt((current_noise_a2_hz(e) + shot) * noise_bandwidth_hz(e)) / e.count_a();
}

double conversion_variance(const data::Electronics& e, double counts) {
  const double amplifier = amplifier_noise_counts(e, counts);
  return amplifier * amplifier + e.converter_noise_counts * e.converter_noise_counts + 1.0 / 12.0;
}

}  // namespace kinemark::camera

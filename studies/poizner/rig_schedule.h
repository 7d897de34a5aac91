// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// When the rig's LEDs are lit and its channels converted, as a recording has it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::studies {

/// One LED's slot of a frame, s after the frame's time.
struct LedSlot {
  std::string led;
  double on_s = 0.0, off_s = 0.0;    ///< the LED is lit in between
  std::vector<double> conversion_s;  ///< beginnings, camera by camera, four channels each
};

/// Slots of all LEDs from the conversion times of a recording: an LED is lit `settle_s` before its first
/// conversion, until its last one has ended. Contract: the counts have cameras.
[[nodiscard]] std::vector<LedSlot> schedule_of(const data::Counts& counts, const data::SlotTiming& timing);

/// A signal that is high (1) between pairs of instants and low (0) elsewhere, from `begin` to `end`: the
/// corners of its trace. Instants outside are left out.
struct PulseTrain {
  Eigen::VectorXd time, level;
};
[[nodiscard]] PulseTrain pulse_train(const std::vector<std::pair<double, double>>& pulses, double begin,
                                     double end);

}  // namespace kinemark::studies

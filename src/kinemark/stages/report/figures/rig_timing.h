// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// When a rig's LEDs are lit and its channels converted: figures 2 and 3 of Poizner, Wooten & Salot (1986) of
// any rig.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/report/figures/figure.h"
#include "kinemark/stages/report/figures/timing_diagram.h"

namespace kinemark::report {

/// One LED's slot of a frame, s after the frame's time.
struct LedSlot {
  std::string led;
  double on_s = 0.0, off_s = 0.0;    ///< the LED is lit in between
  std::vector<double> conversion_s;  ///< beginnings, camera by camera, four channels each
};

/// Slots of all LEDs from the conversion times of a recording, or of a plan: an LED is lit `settle_s` before
/// its first conversion, until its last one has ended. Contract: the counts have cameras.
[[nodiscard]] std::vector<LedSlot> schedule_of(const data::Counts& counts, const data::SlotTiming& timing);

/// A signal that is high (1) between pairs of instants and low (0) elsewhere, from `begin` to `end`: the
/// corners of its trace. Instants outside are left out.
struct PulseTrain {
  Eigen::VectorXd time, level;
};
[[nodiscard]] PulseTrain pulse_train(const std::vector<std::pair<double, double>>& pulses, double begin,
                                     double end);

/// The frame's clock, every LED's pulse and all conversions, one frame and the beginning of the next; ms.
/// @param intensity  height of each LED's pulse, 0 to 1; empty: 1
[[nodiscard]] TimingDiagram frame_timing(const data::Counts& counts, const data::SlotTiming& timing,
                                         const std::vector<double>& intensity = {});

/// One LED's slot: the LED, what an amplifier of that time constant makes of it (0: not drawn), and the
/// conversions of each camera; microseconds.
[[nodiscard]] TimingDiagram slot_timing(const LedSlot& slot, const data::SlotTiming& timing,
                                        double time_constant_s, const std::vector<std::string>& cameras);

/// A panel that is that diagram.
[[nodiscard]] FigurePanel timing_panel(TimingDiagram diagram);

}  // namespace kinemark::report

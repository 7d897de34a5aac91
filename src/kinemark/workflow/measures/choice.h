// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which measures are taken of what, and which intervals they get.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kinemark::workflow {

/// What of a recording is measured: all that it holds, or what one command is about.
enum class MeasuresOf : std::uint8_t {
  everything,  ///< `analyze`
  paths,       ///< `measure`: paths of markers
  walking,     ///< `gait`: feet, steps, force plates
  muscles,     ///< `emg`: electromyograms
};

/// What is asked of measures, be it of markers or of a motion.
struct MeasureChoice {
  std::vector<std::string> measures;  ///< ids; empty: those that apply
  std::vector<std::string> regions;   ///< parse_region()
  std::vector<std::string> between;   ///< labels of events: regions_between()
  std::int64_t refits = 99;           ///< behind each interval; 0: no intervals
  double level = 0.95;                ///< of the intervals
};

}  // namespace kinemark::workflow

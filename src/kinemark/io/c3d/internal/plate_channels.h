// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Analog channels of force plates as files count them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io::internal {

/// The analog channels of a file.
struct AnalogLabels {
  std::vector<std::string> labels;  ///< may be fewer than `count`
  std::int64_t count = 0;
};

/// The number that FORCE_PLATFORM:CHANNEL gives the first analog channel, for plates of `types`: 1 as the
/// format has it; 0, with a warning, where only then the labels name what each channel must be, or where no
/// label names a component and the numbers are 0, 1, 2 and so on without a gap. A single 0 among others is a
/// channel that the plate has not.
[[nodiscard]] int first_channel_number(const C3dParameter* channels, std::span<const double> types,
                                       const AnalogLabels& analog, std::vector<std::string>& warnings);

/// Adds a warning for each plate whose channels all carry labels of components, some of them another one than
/// their order in CHANNEL makes them: which of the two is wrong is not known, CHANNEL is followed.
void note_other_labels(const C3dParameter* channels, std::span<const double> types,
                       const AnalogLabels& analog, int first_number, std::vector<std::string>& warnings);

/// Zero-based channels of plate i; empty when one of them is not in the file.
[[nodiscard]] std::vector<int> channels_of_plate(const C3dParameter* channels, std::size_t i, int type,
                                                 std::int64_t analog_channels, int first_number);

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Plans of a scan for a board of analog inputs, in nanoseconds, and samples as counts. Knows no libcomedi.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"

namespace kinemark::stream {

/// What a board has.
struct BoardFacts {
  std::string name;                             ///< of driver and board
  int channels = 0;                             ///< analog inputs
  std::uint32_t highest_code = 0;               ///< of an input
  std::vector<VoltageRange> ranges;             ///< of the inputs; the first is used
  std::int64_t conversion_ns = 0;               ///< the shortest
  int analog_outputs = 0, digital_outputs = 0;  ///< channels, lines
};

/// A scan: conversions one after the other, again and again.
struct ScanClock {
  std::int64_t scan_ns = 0;        ///< from one scan to the next
  std::int64_t conversion_ns = 0;  ///< from one conversion to the next in it
};

/// Bits of a count: those of the converter, at most 15.
[[nodiscard]] int count_bits(const BoardFacts& facts);
/// The same as others see it: C = channels / 4; it lights no LED.
[[nodiscard]] DeviceCapabilities board_capabilities(const BoardFacts& facts);
/// The clock that a plan asks for: a scan for each LED. Code::usage for what no board can, with the highest
/// rate.
[[nodiscard]] Result<ScanClock> scan_clock(const ScanPlan& plan, const BoardFacts& facts);
/// The plan with the clock that was granted. An LED's slot begins with its first conversion.
[[nodiscard]] GrantedPlan granted_scans(const ScanPlan& plan, const ScanClock& granted,
                                        const BoardFacts& facts);
/// Samples of 2 or 4 bytes behind the counts that are there; codes of more than 15 bits lose their lowest
/// ones. A contract: whole samples.
void append_counts(std::span<const std::byte> samples, std::size_t sample_bytes, const BoardFacts& facts,
                   std::vector<std::int16_t>& counts);

}  // namespace kinemark::stream

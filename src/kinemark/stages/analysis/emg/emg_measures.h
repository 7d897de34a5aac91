// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of electromyograms, each with what chance makes of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/emg/envelope.h"

namespace kinemark::analysis {

/// One channel: S even samples.
struct EmgChannel {
  std::string name;          ///< as the recording has it
  Eigen::VectorXd volts;     ///< S, V; NaN where missing
  double most_volts = kNaN;  ///< of the envelope, what 100 % is; NaN: values are in V
};

/// Samples [first, first + count) of the channels.
struct EmgStretch {
  std::string name;         ///< empty: the whole recording
  std::string context;      ///< "Left", "Right" of a cycle, or empty
  std::int64_t cycle = -1;  ///< from 0; -1: it is none
  std::int64_t first = 0;   ///< its first sample
  std::int64_t count = 0;   ///< samples in it
};

/// What is measured, and how.
struct EmgOptions {
  EnvelopeOptions envelope;           ///< how channels are prepared
  std::vector<std::string> measures;  ///< ids of emg_definitions(); empty: all
  std::vector<EmgStretch> stretches;  ///< empty: the whole recording
  double rest_s = 0.5;                ///< the least time in all that a level is kept which is taken for rest
  double burst_s = 0.05;              ///< the shortest burst and interruption that count
  bool to_maximum = false;            ///< values to the largest envelope of the recording
  std::int64_t refits = 99;           ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double level = 0.95;                ///< of the intervals, above 0.5 to 0.9999
  std::uint64_t seed = 1;             ///< of the simulated channels
  int threads = 1;                    ///< 0: all cores; any number gives the same bits
};

/// All measures, in the order in which they are shown.
[[nodiscard]] std::span<const data::MeasureDefinition> emg_definitions();
/// One by its id, or nothing.
[[nodiscard]] const data::MeasureDefinition* find_emg_definition(std::string_view id);

/// Measures of channels, their envelopes, and what was left out.
struct EmgMeasures {
  std::vector<data::Measure> measures;     ///< by channel and stretch
  std::vector<std::string> names;          ///< K channels that were measured
  std::vector<Eigen::VectorXd> envelopes;  ///< K, each S: V, or shares of `most_volts`
  std::vector<std::string> notes;          ///< a sentence each
  std::vector<std::string> contradicted;   ///< those of them that leave no electromyogram
};

/// Prepare and measure channels (docs/theory/emg.md).
///
/// An electromyogram is noise whose strength the muscle sets. Intervals are those of chance: the channel's
/// envelope times noise of its own spectrum, 99 times, prepared and measured likewise, or for means of what
/// is rectified their law; they are marked approximate. RMS and peak are freed of what the channel shows at
/// rest, in squares. Where no part of a channel is surely at rest, rest and what hangs on bursts are not
/// determined, and RMS and peak are at most.
///
/// @return  Code::usage for options out of range; Code::bad_input where no channel holds half a second of
/// samples
[[nodiscard]] Result<EmgMeasures> measure_emg(const std::vector<EmgChannel>& channels, double rate_hz,
                                              double t0_s, const EmgOptions& options);

}  // namespace kinemark::analysis

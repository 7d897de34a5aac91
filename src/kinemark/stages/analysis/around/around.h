// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Averages around events: of a movement around spikes, of spikes around movements.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"

namespace kinemark::analysis {

/// Window, bins and interval of an average around events.
struct AroundOptions {
  double from_s = -0.5;     ///< start of the window, after the event
  double to_s = 1.0;        ///< its end, above the start by a whole number of bins
  double bin_s = 0.02;      ///< > 0
  double level = 0.95;      ///< of the intervals, above 0.5 and below 1
  double clock_sd_s = 0.0;  ///< one standard deviation of the events' clock against the curves', >= 0

  /// Bins in the window.
  [[nodiscard]] std::int64_t bins() const;
  /// Where a bin begins, after the event; `bins()`: where the last one ends.
  [[nodiscard]] double edge_s(std::int64_t bin) const { return from_s + static_cast<double>(bin) * bin_s; }
  /// Code::usage: numbers out of their range, a window that is not made of whole bins, more than 100,000
  /// bins.
  [[nodiscard]] Status check() const;
};

/// When something is known: nothing is averaged beyond it.
struct ObservedSpan {
  double start_s = kNaN;  ///< first instant
  double end_s = kNaN;    ///< last one
};

/// A movement over time: N samples that straight lines join.
struct SampledCurve {
  std::string subject;                               ///< marker or coordinate
  std::string id;                                    ///< "x", "speed", "angle"
  data::Quantity quantity = data::Quantity::length;  ///< decides the unit
  std::vector<double> time_s;                        ///< N, ascending
  std::vector<double> value;                         ///< N, SI; NaN where missing
};

/// One bin of an average.
struct AroundBin {
  double mean = kNaN;        ///< over the events, SI; NaN without any
  double sd = kNaN;          ///< between events, N - 1; NaN below two
  double low = kNaN;         ///< of the mean's interval; NaN below two
  double high = kNaN;        ///< of the mean's interval
  std::int64_t count = 0;    ///< events that have a value here
  std::int64_t missing = 0;  ///< events whose movement is not known here
};

/// An average around events.
struct AroundCurve {
  std::string events;                                   ///< what they are: "unit 3", "f7 Movement Start"
  std::string subject;                                  ///< whose course: marker, coordinate, unit
  std::string id;                                       ///< of the curve; "rate" of spikes
  data::Quantity quantity = data::Quantity::frequency;  ///< decides the unit
  std::int64_t used = 0;                                ///< events whose window is in the span
  std::int64_t outside = 0;                             ///< events whose window leaves it: not used
  std::vector<AroundBin> bins;                          ///< as AroundOptions::bins()
};

/// Mean of a movement around events. Of each event a bin's value is the mean over the bin of the lines that
/// join the samples; it is missing where one of these ends at a missing sample. The interval is Student's of
/// the mean, plus what the clock's deviation times the slope of the mean adds in squares.
/// @param options  checked
[[nodiscard]] AroundCurve mean_around(const std::string& name, std::span<const double> events_s,
                                      const SampledCurve& curve, const ObservedSpan& span,
                                      const AroundOptions& options);

/// Mean rate of spikes around events, Hz: of each event the spikes in [start, end) of a bin over its length.
/// @param spikes_s  ascending
[[nodiscard]] AroundCurve rate_around(const std::string& name, std::span<const double> events_s,
                                      const std::string& unit, std::span<const double> spikes_s,
                                      const ObservedSpan& span, const AroundOptions& options);

}  // namespace kinemark::analysis

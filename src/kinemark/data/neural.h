// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a session holds beside movement: spikes of units, intervals such as trials, field potentials. All on
// the clock of the recording.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"

namespace kinemark::data {

/// A column of a table and its value in one row: "target", "left".
struct LabelledValue {
  std::string column;  ///< its name
  std::string value;   ///< as text; numbers in their shortest form
};

/// Spikes of one unit.
struct SpikeTrain {
  std::string id;                     ///< of the unit, unique in its file
  std::vector<LabelledValue> labels;  ///< what the file says of it besides ("quality", "location")
  std::vector<double> times_s;        ///< ascending
};

/// A row of a table of intervals.
struct LabelledInterval {
  double start_s = kNaN;              ///< its first instant; NaN: the file does not say
  double stop_s = kNaN;               ///< its last instant, not before the first; NaN: the file does not say
  std::vector<LabelledValue> labels;  ///< its conditions
};

/// Trials, epochs: intervals and what is known of each.
struct IntervalTable {
  std::string name;                    ///< "trials"
  std::vector<LabelledInterval> rows;  ///< as the file has them; each has the same columns
};

/// Samples of field potentials as they go into a file: S samples of K channels at even times.
struct FieldSamples {
  std::string name;                   ///< of the series
  std::vector<std::string> channels;  ///< K
  double rate_hz = 0.0;               ///< > 0
  double t0_s = 0.0;                  ///< of the first sample
  Array<double> values;               ///< S x K, V
};

/// The course of field potentials, reduced to the least and the largest value in each of B bins of equal
/// length: what a drawing needs, whatever the length.
struct FieldEnvelope {
  std::string name;                   ///< of the series
  std::string unit;                   ///< of the values ("volts")
  std::vector<std::string> channels;  ///< K
  double rate_hz = 0.0;               ///< of the samples, > 0; their mean where times are uneven
  double start_s = 0.0;               ///< of the first bin
  double bin_s = 0.0;                 ///< length of a bin, > 0
  std::int64_t bins = 0;              ///< B
  Array<double> low, high;            ///< B x K; NaN where no sample is
};

/// All of it.
struct Neural {
  std::vector<SpikeTrain> units;         ///< in the order of the file
  std::vector<IntervalTable> intervals;  ///< by name; rows by the order of the file
  std::vector<FieldEnvelope> fields;     ///< by path
  std::vector<std::string> warnings;     ///< irregularities of the file, one sentence each

  /// The table of intervals of this name, or null.
  [[nodiscard]] const IntervalTable* find_intervals(std::string_view name) const;
  /// The unit with this id, or null.
  [[nodiscard]] const SpikeTrain* find_unit(std::string_view id) const;
  /// Ids are unique, times finite and ascending, stops not before starts, arrays of their shapes.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data

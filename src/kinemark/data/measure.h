// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A number that says what a movement was, with what is needed to defend it: definition, unit, interval,
// method and how much of it was not measured.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"

namespace kinemark::data {

/// What is measured; it decides the unit.
enum class Quantity : std::uint8_t {
  length,                ///< m
  area,                  ///< m^2
  curvature,             ///< 1/m, also torsion
  time,                  ///< s
  frequency,             ///< Hz
  speed,                 ///< m/s
  acceleration,          ///< m/s^2
  jerk,                  ///< m/s^3
  angle,                 ///< rad
  angular_velocity,      ///< rad/s
  angular_acceleration,  ///< rad/s^2
  force,                 ///< N
  moment,                ///< N m
  power,                 ///< W
  energy,                ///< J
  angular_momentum,      ///< kg m^2/s
  rate,                  ///< 1/s, such as cadence: shown per minute
  voltage,               ///< V
  impulse,               ///< N s
  force_rate,            ///< N/s
  moment_per_mass,       ///< N m/kg
  power_per_mass,        ///< W/kg
  energy_per_mass,       ///< J/kg
  ratio,                 ///< no unit
  share,                 ///< 0 to 1: shown in per cent
  count,                 ///< a whole number
};

/// A unit as files and tables show it.
struct Unit {
  std::string_view name;  ///< "mm", "deg/s"; empty: a number without unit
  double per_si = 1.0;    ///< the number shown of 1 in SI units (radians): 1000 of millimetres
};

/// The unit in which the field writes the quantity: mm, mm/s, deg, 1/min, %, ...
[[nodiscard]] Unit shown_unit(Quantity quantity);
/// "length", "area", "curvature", ...: the name of the enumerator with spaces for underscores.
[[nodiscard]] std::string_view to_string(Quantity quantity);

/// How an interval bounds the truth.
enum class IntervalKind : std::uint8_t { none, two_sided, at_most, at_least };
/// "none", "two-sided", "at most" or "at least".
[[nodiscard]] std::string_view to_string(IntervalKind kind);

/// Where the truth lies with the probability `level`.
struct Interval {
  IntervalKind kind = IntervalKind::none;  ///< which ends are there
  double low = kNaN;                       ///< SI; NaN where there is no lower end
  double high = kNaN;                      ///< SI; NaN where there is no upper end
  double level = 0.95;                     ///< of coverage, above 0 and below 1
  bool approximate = false;  ///< known to cover less than its level in some of the simulated movements
};

/// One measure of one subject in one stretch of one recording.
struct Measure {
  std::string id;           ///< of its definition, as `--list` names it: "path_length"
  std::string subject;      ///< marker, joint, segment or coordinate; empty: the whole body
  std::string context;      ///< "Left", "Right", or empty
  std::string region;       ///< name of the stretch; empty: the whole recording
  std::int64_t cycle = -1;  ///< from 0 where the stretch is one of several cycles; -1: it is none
  double start_s = kNaN;    ///< of the stretch, on the recording's clock
  double end_s = kNaN;      ///< of the stretch; both NaN: the whole recording
  Quantity quantity = Quantity::length;  ///< decides the unit
  double value = kNaN;  ///< SI, bias removed where that is possible; NaN: not determined, `remark` says why
  double uncorrected = kNaN;        ///< SI, before its bias was removed; NaN: nothing was removed
  double sd = kNaN;                 ///< one standard deviation, SI; NaN: not known
  Interval interval;                ///< of the truth
  double share_not_measured = 0.0;  ///< of the samples that it rests on: missing, filled or rejected, 0 to 1
  std::string method;  ///< how it was found where a definition allows several ("refits, 99, seed 1")
  std::string
      remark;  ///< what a reader must know: why there is no interval, what the value is instead; may be empty

  /// Name, share and interval are in range, the ends in order, and a value that is not there is explained.
  [[nodiscard]] Status validate() const;
};

/// What a measure is: one line of `--list`.
struct MeasureDefinition {
  std::string_view id;                   ///< snake_case, unique
  std::string_view group;                ///< "shape", "time", "smoothness", "gait", ...
  Quantity quantity = Quantity::length;  ///< decides the unit
  std::string_view title;                ///< "Path length"
  std::string_view formula;              ///< in words or symbols, one line
  std::string_view source;               ///< paper or book, year, equation; "definition" where it needs none
};

/// Values, and their deviations, over the course of cycles: N cycles at P equally spaced points from 0 to 100
/// %.
struct CycleCurves {
  std::string id;       ///< of what is drawn ("knee_flexion"), unique among the curves of a result
  std::string subject;  ///< marker, joint, segment or coordinate
  std::string context;  ///< "Left", "Right", or empty
  Quantity quantity = Quantity::angle;  ///< decides the unit
  std::int64_t points = 101;            ///< P, at least 2
  std::vector<std::string> cycles;      ///< N names of trial and cycle: "walk2 Left 1"
  std::vector<double> values;           ///< N x P, SI; NaN where not determined
  std::vector<double> sd;               ///< N x P, one standard deviation, SI; empty: not known

  /// N.
  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(cycles.size()); }
  /// A value; NaN where not determined.
  [[nodiscard]] double operator()(std::int64_t cycle, std::int64_t point) const {
    return values[static_cast<std::size_t>(cycle * points + point)];
  }
  /// Arrays have their shapes, deviations are not negative.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data

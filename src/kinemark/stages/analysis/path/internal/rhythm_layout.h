// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Instants and spans of a path that repeat, and where they are in another version of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/stages/analysis/path/path_rhythm.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/rhythm.h"
#include "kinemark/stages/analysis/path/timing.h"

namespace kinemark::analysis::internal {

inline constexpr std::int64_t kPoints = 101;  ///< of a curve over a span
inline constexpr std::int64_t kCurves = 4;    ///< x, y, z, speed

/// An instant of the path that refits are compared with.
struct Instant {
  PathEventKind kind;
  double time_s;       // s from the first sample
  double tolerance_s;  // within which a refit's is the same
};

/// From one instant to another, by their indices.
struct Span {
  std::size_t begin, end;
};

/// What repetitions of one sort are called and which measures tell of them.
struct Sort {
  std::string context;
  std::string_view duration, variation;
  std::vector<std::size_t> spans;  // indices of spans
};

/// Instants and spans of a path, and which spans belong together.
struct Layout {
  std::vector<Instant> instants;
  std::vector<Span> spans;
  std::vector<Sort> sorts;
};

/// What repeats in a path without noise at rest.
struct Repeats {
  std::vector<MovementWindow> movements;
  std::vector<double> crossings;  // of the mean, upward, s
  std::vector<CycleEnds> cycles;  // of a periodic movement
};

/// The times and curves of a layout in one version of the path.
struct Version {
  std::vector<double> times;                // one for each instant, s from the first sample
  std::vector<std::vector<double>> curves;  // one for each span
};

/// The axis or its opposite: that whose largest component is above 0.
[[nodiscard]] Eigen::Vector3d upright(const Eigen::Vector3d& axis);
/// Of one value or more.
[[nodiscard]] double mean_of(const std::vector<double>& values);
/// SD over mean; NaN of fewer than two.
[[nodiscard]] double variation_of(const std::vector<double>& values);

/// Cycles of a path, if it is periodic; a sentence on it.
[[nodiscard]] Repeats find_repeats(const PathSamples& path, const Eigen::Vector3d& axis, PathRhythm& out);
/// Starts and ends of movements; those that have both are spans, by the kind of their way.
void lay_out_movements(const PathSamples& path, const std::vector<MovementWindow>& movements, Layout& out);
/// Crossings between which there are cycles, and those, before the movements.
void lay_out_cycles(const Repeats& found, Layout& out);
/// A layout in a version of the path; curves without the way that a travelling path makes from cycle to
/// cycle.
[[nodiscard]] Version version_of(const PathSamples& path, const Layout& layout, const Eigen::Vector3d& axis,
                                 bool travels);

}  // namespace kinemark::analysis::internal

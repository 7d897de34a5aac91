// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of force plates: steps on them, and the sway of somebody who stands on them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/math/difference_smoother.h"

namespace kinemark::analysis {

/// What a measure of plates is of.
enum class ForceScope : std::uint8_t {
  step,  ///< a contact from landing to leaving
  sway,  ///< a stretch throughout which somebody stands: the plates together
};

/// What is settled of a step or a stretch of standing, and a version of its samples.
struct ForceView {
  Eigen::MatrixX3d force;       ///< n x 3, N; of a step
  Eigen::VectorXd load;         ///< n, N, against gravity; of a step
  Eigen::Vector3d travel;       ///< direction in which the step goes; 0: not known
  math::SeriesMatrix pressure;  ///< n x 2, horizontal centre of pressure, m; of standing
  double rate_hz = 0.0;         ///< of all of them
};

/// One measure of plates.
struct ForceDefinition {
  data::MeasureDefinition what;                      ///< its line in `--list`
  ForceScope scope = ForceScope::step;               ///< what it is of
  double (*value)(const ForceView& view) = nullptr;  ///< SI; NaN where not determined
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const ForceDefinition> force_definitions();
/// One by its id, or nothing.
[[nodiscard]] const ForceDefinition* find_force_definition(std::string_view id);

/// What is measured, and how.
struct ForceMeasureOptions {
  std::vector<std::string> measures;        ///< ids of force_definitions(); empty: all that apply
  std::vector<data::Region> regions;        ///< of whole steps, of standing; empty: the whole recording
  std::span<const data::GaitEvent> events;  ///< that tell whose steps were on which plate
  std::int64_t refits = 99;  ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double level = 0.95;       ///< of the intervals, above 0.5 to 0.9999
  std::uint64_t seed = 1;    ///< of the refits
};

/// Measures of plates, and what was left out.
struct ForceMeasures {
  std::vector<data::Measure> measures;  ///< by plate and step, then standing by region
  std::vector<std::string> notes;       ///< a sentence each
};

/// Find steps and standing on plates and measure them (docs/theory/force-measures.md).
///
/// Upwards is the axis along which the plates push most. A step is a whole contact of 0.05 to 3 s; standing
/// is a stretch of 5 s or more (2 s of a region) throughout which the plates together bear more than 100 N.
/// White noise of forces and of the centre of pressure is found from their sixth differences and its bias
/// removed, as for paths; that the same person sways otherwise the next time is not in the intervals.
///
/// @param plates  forces that were not cut off at a threshold
/// @return        Code::bad_input where nobody stands or steps on a plate
[[nodiscard]] Result<ForceMeasures> measure_forces(const data::Wrenches& plates,
                                                   const ForceMeasureOptions& options);

}  // namespace kinemark::analysis

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events and repetitions of one marker's path, each with its deviation by refits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/measure.h"

namespace kinemark::analysis {

/// What happens at an instant of a path.
enum class PathEventKind : std::uint8_t {
  movement_start,  ///< the speed rises beyond kMovingShare of its peak, and stays there
  movement_end,    ///< it falls below
  cycle_start      ///< a periodic movement crosses its mean upward along its main axis
};
/// "Movement Start", "Movement End", "Cycle Start".
[[nodiscard]] std::string_view to_string(PathEventKind kind);

/// An instant of a path.
struct PathEvent {
  PathEventKind kind = PathEventKind::movement_start;  ///< what happens
  double time_s = kNaN;  ///< on the recording's clock, freed of the bias of noise
  double sd_s = kNaN;    ///< one standard deviation by refits; NaN: not known
};

/// What repeats in a stretch of one marker's path.
struct PathRhythm {
  std::string subject;            ///< marker
  std::string region;             ///< name of the stretch; empty: the whole recording
  double start_s = kNaN;          ///< first sample of the stretch, on the recording's clock
  double end_s = kNaN;            ///< last one
  std::vector<PathEvent> events;  ///< ascending in time
  bool periodic = false;          ///< it has cycles
  double period_s = kNaN;         ///< by autocorrelation; NaN: none
  std::string verdict;            ///< a sentence: how it moves, and why it has no cycles
  /// x, y, z (m) and speed (m/s) over the cycles, context "cycle", and over the movements of a kind from
  /// start to end, context "movement", or "movement 1", "movement 2" where there are several kinds;
  /// deviations are of noise, none without refits. Places of a movement that travels while it repeats are
  /// without the way from its first cycle to its last.
  std::vector<data::CycleCurves> curves;
  std::vector<data::Measure> measures;  ///< of rhythm_definitions(): each duration, and their variation
};

/// Durations of cycles and movements, one by one, and their variation.
[[nodiscard]] std::span<const data::MeasureDefinition> rhythm_definitions();
/// The one with this id, or null.
[[nodiscard]] const data::MeasureDefinition* find_rhythm_definition(std::string_view id);

}  // namespace kinemark::analysis

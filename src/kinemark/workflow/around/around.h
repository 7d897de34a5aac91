// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Peri-event averages of a session: a movement around spikes, spikes around a movement.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/neural.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/around/around.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// Around what, in which window.
struct AroundChoice : analysis::AroundOptions {
  /// "units": spikes of each unit; "unit:3": of one; "movement": starts of the markers' own movements;
  /// "trials" or another table of intervals: its starts, "trials:side" for each value of a column apart; else
  /// the label of the recording's events.
  std::string what;
  double clock_offset_s = 0.0;  ///< added to the times of spikes and intervals: brings them onto the
                                ///< recording's clock
};

/// Events of one kind.
struct NamedEvents {
  std::string name;             ///< "f7 Movement Start"
  std::vector<double> times_s;  ///< on the recording's clock
};

/// What was recorded of a movement.
struct MovementSession {
  std::vector<analysis::SampledCurve> curves;  ///< averaged around spikes
  analysis::ObservedSpan span;                 ///< when it was recorded
  std::vector<data::Event> events;             ///< that the file has
  std::vector<NamedEvents> movements;          ///< starts of movements, where these are asked for
};

/// Averages and what is to be said of them.
struct AroundFound {
  std::vector<analysis::AroundCurve> curves;  ///< by event, then by course
  Remarks remarks;                            ///< events and spikes that are left out
};

/// The events that `what` names are starts of the markers' own movements: MovementSession::movements is
/// looked at.
[[nodiscard]] bool wants_movements(const AroundChoice& choice);

/// Around spikes: the mean of every curve of the movement. Around anything else: the mean rate of every unit.
/// Events whose window leaves the recording, and spikes outside it, are counted in a warning.
///
/// Code::usage as AroundOptions::check() and for a unit, a table, a column or a label that does not exist,
/// with the nearest names. Code::bad_input where there are no units, no events of this kind, or where all
/// spikes or intervals lie outside the recording: two clocks.
[[nodiscard]] Result<AroundFound> around(const MovementSession& session, data::Neural neural,
                                         const AroundChoice& choice);

}  // namespace kinemark::workflow

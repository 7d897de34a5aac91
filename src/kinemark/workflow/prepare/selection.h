// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A part of a recording: some of its markers, some of its frames, other names.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow {

/// What is kept of a recording and what it is called. Names stand for markers and for channels that are no
/// markers; * is any text in them and ? any letter; a subject's prefix may be left out where one subject
/// alone has the name.
struct Selection {
  std::vector<std::string> select;  ///< keep these alone, in the recording's order; empty: all
  std::vector<std::string> drop;    ///< leave these out
  std::vector<std::string> rename;  ///< "OLD=NEW", after both, all at once: two names can change places
  double first_time_s = -std::numeric_limits<double>::infinity();  ///< on the recording's clock
  double last_time_s = std::numeric_limits<double>::infinity();    ///< included
  std::string frames;  ///< "101-250", "101-", "-250" in the file's own numbers, both included; empty: by time

  /// Whether everything is kept as it is.
  [[nodiscard]] bool empty() const;
  /// The same without times, for a job whose solver has a range of its own.
  [[nodiscard]] Selection without_times() const;
  /// The same with those names alone that a recording has, and no frames: for a recording beside another.
  [[nodiscard]] Selection names_in(const data::Trial& trial) const;
  /// What can be said without a recording: Code::usage.
  [[nodiscard]] Status check() const;
};

/// Keeps the chosen part of `trial`: markers with all that is known of their samples, channels, analog
/// samples, events. Frames keep their numbers and times; analog samples of the last frame are kept whole. How
/// many events lay outside goes to the warnings.
///
/// Code::bad_input, and the trial as it was: a name that is not there (with the nearest ones), a range
/// without frames, no marker left, one name for two. O(samples).
[[nodiscard]] Status take_selection(const Selection& selection, data::Trial& trial);

}  // namespace kinemark::workflow

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Trials of a file as spans that are measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/neural.h"
#include "kinemark/pipeline/measures/recording_name.h"

namespace kinemark::pipeline {

/// Spans with what the file says of each.
struct TrialSpans {
  std::vector<data::Region> regions;  ///< "trial 1", "trial 2", ... in the recording's own frames
  SpanLabels labels;                  ///< conditions by region
  std::vector<std::string> notes;     ///< how many there are, and which are left out
};

/// The intervals of a table as spans, frames nearest to their ends; those that are not wholly in the
/// recording are left out with a note.
[[nodiscard]] TrialSpans spans_of(const data::IntervalTable& table, const TimeBase& time);

/// Spans of a recording's file. No other file than .nwb has intervals.
///
/// @param name  of the table; "none": no spans; empty: "trials", where the file has them
/// @return      Code::usage for a table that the file has not, with those that it has, and for a name that is
///              given of a file that is no .nwb; a fault of the file is a note where no name is given, else
///              as io::read_neural()
[[nodiscard]] Result<TrialSpans> trial_spans(const std::filesystem::path& file, const std::string& name,
                                             const TimeBase& time);

/// The word of --trials that leaves them alone.
inline constexpr const char* kNoTrials = "none";

}  // namespace kinemark::pipeline

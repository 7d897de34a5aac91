// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures as tables of NWB.
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/data/measure.h"
#include "kinemark/data/run_record.h"
#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/recording_name.h"

namespace kinemark::pipeline {

/// Measures of one recording.
struct NamedMeasures {
  RecordingName name;                   ///< of its rows
  std::vector<data::Measure> measures;  ///< in their order
  std::vector<EventRow> events = {};    ///< of feet, or of the markers' own movements
};

/// Tables. `measures`: a row for each recording, subject, context, region and cycle, four columns for
/// each measure (value, _low, _high, _error_sd; NaN where not determined), whose descriptions say what it is,
/// its unit and its source. `measures_tidy`: the rows and columns of measures_csv(). `measure_definitions`:
/// each measure's title, unit, formula and source. Where there are events a fourth, `movement_events`: the
/// columns of events_csv().
[[nodiscard]] std::vector<io::NwbTable> measure_tables(const std::vector<NamedMeasures>& recordings);

/// The file of these tables, with what it was made of and how.
/// @param beside  of the one recording that is measured: the tables go into a copy of its file. Of no file:
/// they
///                are alone
[[nodiscard]] ResultFile nwb_file(std::filesystem::path target, std::vector<NamedMeasures> recordings,
                                  const std::vector<data::InputFile>& inputs, const JobSettings& settings,
                                  data::Beside beside = {});

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures as files and people see them: in the units of the field.
#pragma once

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <string_view>

#include "kinemark/data/measure.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/path/path_noise.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {

// The noise of markers as results hold it.

/// One object a marker: "subject", "source", "kind", "sd_mm" (per axis, before any filter), "found_mm", where
/// there are "sample_sd_mm" (of a sample as recorded) and "stated_mm", "correlation" with
/// "correlation_time_s", "filter" ("form", "order", "cutoff_hz" with "low_hz" and "high_hz", 95 %, -3 dB,
/// "half_amplitude_hz"), "floor_mm", "rounding_step_mm"; "slow_noise_mm" (0.2 to 2 Hz: "low", "middle",
/// "high", 10, 50 and 90 %), "slow_noise_unknown" and "outliers". null where not known.
[[nodiscard]] nlohmann::ordered_json noises_json(std::span<const analysis::PathNoise> noises);

/// A tidy table, one measure a row: file, participant, session, trial, subject, context, region, cycle,
/// start_s, end_s, measure, value, unit, low, high, level, interval, approximate, sd, uncorrected,
/// share_not_measured, method, remark, the columns of the participants' table and those of trials. Values in
/// the unit of the row, nine digits; empty where not determined. RFC 4180.
[[nodiscard]] std::string measures_csv(std::span<const data::Measure> measures,
                                       const RecordingName& recording);
/// Columns of trials whose name the table has already get the prefix "span_".
void name_span_columns(RecordingName& recording);
/// Its first line alone.
[[nodiscard]] std::string measures_csv_columns(const RecordingName& recording);
/// Its other lines.
[[nodiscard]] std::string measures_csv_rows(std::span<const data::Measure> measures,
                                            const RecordingName& recording);

/// The same as a list of objects; null where not determined.
[[nodiscard]] nlohmann::ordered_json measures_json(std::span<const data::Measure> measures);

/// For people, a block for each marker and region: title, value with its interval and unit, what must be
/// known of it.
[[nodiscard]] std::string measures_text(std::span<const data::Measure> measures);

/// "340.12 [339.70 to 340.55] mm": the value with its interval and unit.
[[nodiscard]] std::string shown_value(const data::Measure& measure);
/// What the definition calls it, "Path length"; the id where there is none.
[[nodiscard]] std::string title_of_measure(const std::string& id);
/// The same with its side: "Stride time, Left".
[[nodiscard]] std::string title_of_measure(const data::Measure& measure);

/// What each measure is that a command is about, one line each: id, what it is, unit, formula, source.
[[nodiscard]] std::string measure_list(workflow::MeasuresOf of = workflow::MeasuresOf::everything);
/// The same as a list of objects.
[[nodiscard]] nlohmann::ordered_json measure_list_json(
    workflow::MeasuresOf of = workflow::MeasuresOf::everything);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures as files and people see them: in the units of the field.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "kinemark/data/measure.h"

namespace kinemark::pipeline {

/// A cell of a table as RFC 4180 has it: in quotes where it holds commas, quotes or ends of lines.
[[nodiscard]] std::string csv_quoted(const std::string& text);

/// A tidy table, one measure a row: file, subject, context, region, cycle, start_s, end_s, measure, value,
/// unit, low, high, level, interval, approximate, sd, uncorrected, share_not_measured, method, remark. Values
/// in the unit of the row, nine digits; empty where not determined. RFC 4180.
/// @param file  name of the recording, in every row
[[nodiscard]] std::string measures_csv(std::span<const data::Measure> measures, const std::string& file);

/// The same as a list of objects; null where not determined.
[[nodiscard]] nlohmann::ordered_json measures_json(std::span<const data::Measure> measures);

/// For people, a block for each marker and region: title, value with its interval and unit, what must be
/// known of it.
[[nodiscard]] std::string measures_text(std::span<const data::Measure> measures);

/// What each measure of a path is, one line each: id, what it is, unit, formula, source.
[[nodiscard]] std::string measure_list();
/// The same as a list of objects.
[[nodiscard]] nlohmann::ordered_json measure_list_json();

}  // namespace kinemark::pipeline

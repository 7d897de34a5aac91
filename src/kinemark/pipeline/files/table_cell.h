// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cells of tables that are written as comma-separated values, and the same numbers in JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kinemark::pipeline {

/// Nine digits; empty unless finite.
[[nodiscard]] std::string table_cell(double value);
/// As RFC 4180 has it: quoted where it must be. A text that a spreadsheet would take for a formula (it begins
/// with =, +, - or @, and is no number) gets an apostrophe before it, and so does one that begins with
/// apostrophes and then one of these; io::read_tidy_csv() takes one off again.
[[nodiscard]] std::string table_cell(const std::string& text);
/// A number; null unless finite.
[[nodiscard]] nlohmann::ordered_json json_number(double value);

}  // namespace kinemark::pipeline

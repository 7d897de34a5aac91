// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/table_cell.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/core/number.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {

std::string table_cell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

std::string table_cell(const std::string& given) {
  const std::string text = io::is_like_formula(given) && !parse_number(given) ? "'" + given : given;
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace kinemark::pipeline

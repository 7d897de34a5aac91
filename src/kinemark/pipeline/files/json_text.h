// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kinemark::pipeline {

/// JSON as this program prints and writes it, two blanks deep: always valid UTF-8 (other bytes, of file
/// names, become U+FFFD) and without a raw control character, whatever the names in it.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Numbers of JSON as the writers of points give them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "kinemark/core/missing.h"

namespace kinemark::io::internal {

/// A number; null, and anything else, is NaN.
inline double number_or_nan(const nlohmann::json& json) {
  return json.is_number() ? json.get<double>() : kNaN;
}

/// Whether it is an array of numbers and nulls.
inline bool is_row(const nlohmann::json& json) {
  if (!json.is_array()) return false;
  for (const auto& value : json)
    if (!value.is_number() && !value.is_null()) return false;
  return true;
}

/// The whole number under the first of these keys that has one; [n] is n.
inline std::optional<std::int64_t> whole_number(const nlohmann::json& json,
                                                std::initializer_list<const char*> keys) {
  if (!json.is_object()) return {};
  for (const char* key : keys) {
    const auto found = json.find(key);
    if (found == json.end()) continue;
    const auto& value = found->is_array() && found->size() == 1 ? found->front() : *found;
    if (value.is_number_integer()) return value.get<std::int64_t>();
  }
  return {};
}

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/distinct_names.h"

#include <fmt/core.h>

#include <unordered_map>
#include <unordered_set>

namespace kinemark {

RepeatedNames make_distinct(std::span<std::string> names) {
  RepeatedNames repeated;
  const std::unordered_set<std::string> given(names.begin(), names.end());
  if (given.size() == names.size()) return repeated;
  std::unordered_set<std::string> used;
  std::unordered_map<std::string, int> last_number;
  for (std::string& name : names) {
    if (used.insert(name).second) continue;
    if (repeated.changed++ == 0) repeated.example = name;
    std::string other;
    int& number = last_number.try_emplace(name, 1).first->second;
    do other = fmt::format("{}_{}", name, ++number);
    while (given.contains(other) || !used.insert(other).second);
    name = std::move(other);
  }
  return repeated;
}

}  // namespace kinemark

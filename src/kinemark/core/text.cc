// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/text.h"

namespace kinemark {

std::string join(std::span<const std::string> names, std::string_view between) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += between;
    text += names[i];
  }
  return text;
}

std::string join_some(std::span<const std::string> names, std::size_t most) {
  if (names.size() <= most) return join(names);
  return join(names.first(most)) + " and " + std::to_string(names.size() - most) + " more";
}

std::string join_names(std::span<const std::string> names, std::size_t most) {
  if (names.size() < 2 || names.size() > most) return join_some(names, most);
  return join(names.first(names.size() - 1)) + " and " + names.back();
}

}  // namespace kinemark

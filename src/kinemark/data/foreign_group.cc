// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/foreign_group.h"

#include <algorithm>
#include <cctype>

#include "kinemark/core/utf8.h"

namespace kinemark::data {

std::string foreign_name(std::string_view stored) {
  std::string name = name_of_bytes(stored);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

}  // namespace kinemark::data

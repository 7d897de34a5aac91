// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/many_inputs.h"

#include <system_error>

namespace kinemark::cli {

bool are_many(const std::vector<std::filesystem::path>& given) {
  std::error_code ignored;
  return given.size() > 1 || (given.size() == 1 && std::filesystem::is_directory(given.front(), ignored));
}

}  // namespace kinemark::cli

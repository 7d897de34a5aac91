// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_data.h"

#include <cstdlib>

namespace kinemark::testing_support {

std::filesystem::path project_folder() { return KINEMARK_PROJECT_FOLDER; }

std::optional<std::filesystem::path> test_data_folder() {
  const char* named = std::getenv("KINEMARK_TEST_DATA");
  const std::filesystem::path folder = named != nullptr && *named != '\0'
                                           ? std::filesystem::path(named)
                                           : project_folder() / ".." / "shared" / "data";
  if (!std::filesystem::is_regular_file(folder / "README.md")) return std::nullopt;
  return std::filesystem::canonical(folder);
}

}  // namespace kinemark::testing_support

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace kinemark::testing_support {

/// Folder of real recordings (environment variable KINEMARK_TEST_DATA, default ../shared/data beside the
/// project), or nothing when it is absent.
[[nodiscard]] std::optional<std::filesystem::path> test_data_folder();

/// Folder of this project's sources (models/, examples/).
[[nodiscard]] std::filesystem::path project_folder();

}  // namespace kinemark::testing_support
// NOLINTBEGIN(bugprone-macro-parentheses): the argument is the name that is declared
/// In a test body: `KINEMARK_REQUIRE_TEST_DATA(data);` declares `data`, the folder, or skips the test loudly.
#define KINEMARK_REQUIRE_TEST_DATA(folder)                                                         \
  const auto folder##_found = ::kinemark::testing_support::test_data_folder();                     \
  if (!folder##_found)                                                                             \
    GTEST_SKIP() << "SKIPPED, NOT TESTED: the real recordings are absent; set KINEMARK_TEST_DATA"; \
  const std::filesystem::path& folder = *folder##_found
// NOLINTEND(bugprone-macro-parentheses)

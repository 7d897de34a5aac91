// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kinemark::pipeline {

/// The page of a desk: `kinemark.desk` of the viewer, which asks its server for the state at "/api/desk".
/// @param source  address that was given  @param folder  of the trials
[[nodiscard]] std::string desk_page(const std::string& source, const std::filesystem::path& folder);

}  // namespace kinemark::pipeline

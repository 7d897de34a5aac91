// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/settings_file.h"

namespace kinemark::pipeline {

/// The options in a table, in the order of the file; as parse_settings(). @param name  of the file
[[nodiscard]] Result<Settings> settings_of(const toml::table& table, const std::string& name);

}  // namespace kinemark::pipeline

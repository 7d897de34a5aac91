// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// The name after this one: its number at the end counted up, as wide as before; one without gets "_02".
[[nodiscard]] std::string next_trial(const std::string& name);

/// That name, or the first one counted on from it of which there is no FOLDER/NAME.mcap.
[[nodiscard]] std::string free_trial(const std::filesystem::path& folder, const std::string& name);

/// The recording of a trial.
[[nodiscard]] std::filesystem::path trial_file(const std::filesystem::path& folder, const std::string& name);

/// Code::usage for a name that cannot be a file's: empty, longer than 200 bytes, hidden, with a '/', a '\' or
/// a control character.
[[nodiscard]] Status check_trial_name(const std::string& name);

}  // namespace kinemark::pipeline

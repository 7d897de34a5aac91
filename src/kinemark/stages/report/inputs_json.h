// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "kinemark/data/run_record.h"

namespace kinemark::report {

/// Files that a result was made from, as every record of a run lists them: role, path, bytes, hash and
/// hash_kind, InputFile of docs/formats/pages.md.
[[nodiscard]] nlohmann::ordered_json inputs_json(std::span<const data::InputFile> inputs);

}  // namespace kinemark::report

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segment definitions as files: docs/formats/segments.md
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::pipeline {

/// Read a definition, TOML. Code::bad_input with file and place for what does not fit; it has been checked.
[[nodiscard]] Result<analysis::SegmentDefinition> read_definition(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file.
[[nodiscard]] Result<analysis::SegmentDefinition> parse_definition(std::string_view text,
                                                                   const std::string& name);

/// A definition that travels inside the program.
struct ShippedDefinition {
  std::string_view name;  ///< "pig"
  std::string_view text;  ///< TOML
};
/// All of them.
[[nodiscard]] std::vector<ShippedDefinition> shipped_definitions();

/// A shipped definition by its name, else a file. Code::usage for a name that is neither.
[[nodiscard]] Result<analysis::SegmentDefinition> find_definition(const std::string& name_or_path);

}  // namespace kinemark::pipeline

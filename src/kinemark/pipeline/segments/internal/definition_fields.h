// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Entries of a definition field by field.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"
#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::pipeline::internal {

/// "x", "y", "z" as 0, 1, 2.
[[nodiscard]] std::optional<int> axis_of(std::string_view text);
/// "-y" or "+y" or "y" as an axis and 1 or -1.
[[nodiscard]] std::optional<std::pair<int, double>> signed_axis_of(std::string_view text);
/// A formula; a failure says where and of which key.
[[nodiscard]] Result<analysis::Formula> formula_of(const std::string& text, const std::string& where,
                                                   std::string_view key);
/// The formula of a key, where it is there.
[[nodiscard]] Status take_formula(io::TomlFields& fields, std::string_view key,
                                  std::optional<analysis::Formula>& out);
/// The formula of a key that must be there.
[[nodiscard]] Status take_formula(io::TomlFields& fields, std::string_view key, analysis::Formula& out);

/// [[body]].
[[nodiscard]] Result<analysis::SegmentDefinition::Body> read_body(io::TomlFields& fields);
/// [[joint]]; `table` has its lists of lists, `fields` the rest.
[[nodiscard]] Result<analysis::SegmentDefinition::Joint> read_joint(io::TomlFields& fields,
                                                                    const toml::table& table);

}  // namespace kinemark::pipeline::internal

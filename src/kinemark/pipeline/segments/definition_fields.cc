// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "kinemark/pipeline/segments/internal/definition_fields.h"

namespace kinemark::pipeline::internal {

using analysis::Formula;
using Need = io::TomlFields::Need;

std::optional<int> axis_of(std::string_view text) {
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
  return text[0] - 'x';
}

std::optional<std::pair<int, double>> signed_axis_of(std::string_view text) {
  const bool has_sign = text.starts_with('-') || text.starts_with('+');
  const auto axis = axis_of(has_sign ? text.substr(1) : text);
  if (!axis) return std::nullopt;
  return std::pair(*axis, text.front() == '-' ? -1.0 : 1.0);
}

Result<Formula> formula_of(const std::string& text, const std::string& where, std::string_view key) {
  auto made = analysis::parse_formula(text);
  if (!made) return fail(Code::bad_input, fmt::format("{}: {}: {}", where, key, made.error().message));
  return made;
}

Status take_formula(io::TomlFields& fields, std::string_view key, std::optional<Formula>& out) {
  std::string text;
  fields.text(key, text);
  if (text.empty()) return {};
  auto made = formula_of(text, fields.where(), key);
  if (!made) return std::unexpected(made.error());
  out = std::move(*made);
  return {};
}

Status take_formula(io::TomlFields& fields, std::string_view key, Formula& out) {
  std::string text;
  fields.text(key, text, Need::required);
  if (fields.failed()) return fields.finish();
  auto made = formula_of(text, fields.where(), key);
  if (!made) return std::unexpected(made.error());
  out = std::move(*made);
  return {};
}

}  // namespace kinemark::pipeline::internal

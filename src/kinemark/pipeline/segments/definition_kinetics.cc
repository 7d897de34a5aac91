// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bodies with mass and joints of a definition.
#include <fmt/core.h>

#include <utility>

#include "kinemark/pipeline/segments/internal/definition_fields.h"

namespace kinemark::pipeline::internal {
namespace {

using Definition = analysis::SegmentDefinition;
using Need = io::TomlFields::Need;

Status take_formulas(io::TomlFields& fields, std::string_view key, std::vector<std::string>& texts,
                     std::vector<analysis::Formula>& out, Need need) {
  fields.texts(key, texts, need);
  if (fields.failed()) return fields.finish();
  for (const auto& text : texts) {
    auto made = formula_of(text, fields.where(), key);
    if (!made) return std::unexpected(made.error());
    out.push_back(std::move(*made));
  }
  return {};
}

// [["extension", "-y"], ["valgus", "x"], ["external_rotation", "z"]]
Status read_axes(const toml::table& table, std::string_view key, const std::string& where,
                 std::array<Definition::AxisComponent, 3>& out) {
  const auto wrong =
      fail(Code::bad_input,
           fmt::format("{}: {}: expected three of [\"LABEL\", \"-y\"], an axis each", where, key));
  const auto* list = table[key].as_array();
  if (list == nullptr || list->size() != out.size()) return wrong;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto* pair = (*list)[k].as_array();
    if (pair == nullptr || pair->size() != 2) return wrong;
    const auto label = (*pair)[0].value<std::string>();
    const auto axis = signed_axis_of((*pair)[1].value_or(std::string()));
    if (!label || label->empty() || !axis) return wrong;
    out[k] = {.label = *label, .axis = axis->first, .sign = axis->second};
  }
  if (out[0].axis == out[1].axis || out[0].axis == out[2].axis || out[1].axis == out[2].axis) return wrong;
  return {};
}

}  // namespace

Result<Definition::Body> read_body(io::TomlFields& fields) {
  Definition::Body out;
  std::vector<std::string> gyration, floor;
  std::vector<analysis::Formula> radii;
  fields.text("name", out.name, Need::required)
      .text("segment", out.segment, Need::required)
      .text("ground_reaction", out.ground_reaction);
  if (auto s = take_formula(fields, "mass", out.mass); !s) return std::unexpected(s.error());
  if (auto s = take_formula(fields, "centre", out.centre); !s) return std::unexpected(s.error());
  if (auto s = take_formulas(fields, "gyration", gyration, radii, Need::required); !s)
    return std::unexpected(s.error());
  if (radii.size() != out.gyration.size())
    return fail(Code::bad_input,
                fields.where() + ": gyration: expected radii about x, y and z, three formulas");
  for (std::size_t k = 0; k < radii.size(); ++k) out.gyration[k] = std::move(radii[k]);
  if (auto s = take_formulas(fields, "floor", floor, out.floor, Need::optional); !s)
    return std::unexpected(s.error());
  if (!out.ground_reaction.empty() && out.floor.empty())
    return fail(Code::bad_input, fields.where() + ": ground_reaction needs points of the 'floor'");
  return out;
}

Result<Definition::Joint> read_joint(io::TomlFields& fields, const toml::table& table) {
  Definition::Joint out;
  fields.text("name", out.name, Need::required)
      .text("parent", out.parent, Need::required)
      .text("child", out.child, Need::required)
      .texts("bodies", out.bodies, Need::required);
  if (auto s = take_formula(fields, "centre", out.centre); !s) return std::unexpected(s.error());
  if (auto s = take_formula(fields, "per", out.per); !s) return std::unexpected(s.error());
  if (auto s = read_axes(table, "moment", fields.where(), out.moment); !s) return std::unexpected(s.error());
  if (auto s = read_axes(table, "force", fields.where(), out.force); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::pipeline::internal

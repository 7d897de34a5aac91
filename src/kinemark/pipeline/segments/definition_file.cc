// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/definition_file.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/io/file.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"
#include "kinemark/pipeline/segments/internal/definition_fields.h"
#include "kinemark/pipeline/segments/internal/shipped_text.h"

namespace kinemark::pipeline {
namespace {

using analysis::Formula;
using analysis::InTrial;
using internal::axis_of;
using internal::formula_of;
using internal::take_formula;
using Definition = analysis::SegmentDefinition;
using Need = io::TomlFields::Need;

constexpr std::size_t kMostBytes = 4UL << 20;

/// For whom an entry with braces is made.
struct Side {
  std::string letter, word;
  bool positive = true;
};

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

std::string for_side(std::string text, const Side& side) {
  replace_all(text, "{S}", side.letter);
  replace_all(text, "{Side}", side.word);
  replace_all(text, "{+}", side.positive ? "+" : "-");
  replace_all(text, "{-}", side.positive ? "-" : "+");
  return text;
}

/// The node with every text written for a side; whether a text had braces.
bool write_for_side(toml::node& node, const Side& side) {
  bool braces = false;
  if (auto* text = node.as_string()) {
    std::string made = for_side(text->get(), side);
    braces = made != text->get();
    *text = std::move(made);
  } else if (auto* list = node.as_array()) {
    for (auto& item : *list) braces = write_for_side(item, side) || braces;
  } else if (auto* table = node.as_table()) {
    for (auto&& [key, item] : *table) braces = write_for_side(item, side) || braces;
  }
  return braces;
}

Result<std::vector<Side>> read_sides(const toml::table& root, const std::string& where) {
  std::vector<Side> out;
  if (!root.contains("sides")) return out;
  const auto wrong = fail(Code::bad_input, where +
                                               ": sides are lists of a letter, a word and 1 or -1, such as "
                                               "[[\"L\", \"Left\", 1], [\"R\", \"Right\", -1]]");
  const auto* list = root["sides"].as_array();
  if (list == nullptr) return wrong;
  for (const auto& item : *list) {
    const auto* one = item.as_array();
    if (one == nullptr || one->size() != 3) return wrong;
    const auto letter = (*one)[0].value<std::string>(), word = (*one)[1].value<std::string>();
    const auto sign = (*one)[2].value<std::int64_t>();
    if (!letter || !word || !sign || (*sign != 1 && *sign != -1)) return wrong;
    out.push_back({*letter, *word, *sign == 1});
  }
  return out;
}

// ["y", "LASI - RASI"]
Status take_direction(io::TomlFields& fields, std::string_view key, int& axis, Formula& along) {
  std::vector<std::string> pair;
  fields.texts(key, pair, Need::required);
  if (fields.failed()) return fields.finish();
  const auto of = pair.size() == 2 ? axis_of(pair[0]) : std::nullopt;
  if (!of)
    return fail(Code::bad_input,
                fmt::format("{}: {}: expected [\"x\", \"FORMULA\"] with x, y or z", fields.where(), key));
  axis = *of;
  auto made = formula_of(pair[1], fields.where(), key);
  if (!made) return std::unexpected(made.error());
  along = std::move(*made);
  return {};
}

Status take_trial(io::TomlFields& fields, InTrial& out) {
  std::string text = "any";
  fields.text("trial", text);
  if (text == "any")
    out = InTrial::any;
  else if (text == "static")
    out = InTrial::fixed;
  else if (text == "moving")
    out = InTrial::moving;
  else
    fields.refuse("trial", "\"any\", \"static\" or \"moving\"");
  return {};
}

void take_quantity(io::TomlFields& fields, analysis::SubjectQuantity& out) {
  std::string text(to_string(out));
  fields.text("quantity", text);
  if (const auto quantity = analysis::subject_quantity_of(text))
    out = *quantity;
  else
    fields.refuse("quantity", "\"number\", \"length\", \"angle\" or \"mass\"");
}

Result<Definition::Parameter> read_parameter(io::TomlFields& fields) {
  Definition::Parameter out;
  std::string where_measured = "static";
  fields.text("name", out.name, Need::required)
      .texts("also", out.also)
      .flag("zero_is_unknown", out.zero_is_unknown)
      .flag("entered_first", out.entered_first)
      .numbers("choices", out.choices)
      .texts("chosen_by", out.chosen_by);
  take_quantity(fields, out.quantity);
  for (const auto& [key, formula] : {std::pair{"measured", &out.measured},
                                     {"formula", &out.formula},
                                     {"sd", &out.formula_sd},
                                     {"assumed_sd", &out.assumed_sd},
                                     {"zero_sd", &out.zero_sd}})
    if (auto s = take_formula(fields, key, *formula); !s) return std::unexpected(s.error());
  std::vector<std::string> shown;
  std::string where_shown = "moving";
  fields.texts("shown", shown).text("shown_in", where_shown);
  if (where_shown != "moving" && where_shown != "any") fields.refuse("shown_in", "\"moving\" or \"any\"");
  out.shown_anywhere = where_shown == "any";
  for (const auto& text : shown) {
    auto made = formula_of(text, fields.where(), "shown");
    if (!made) return std::unexpected(made.error());
    out.shown.push_back(std::move(*made));
  }
  fields.text("measured_in", where_measured);
  if (where_measured != "static" && where_measured != "any" && where_measured != "recording")
    fields.refuse("measured_in", "\"static\", \"any\" or \"recording\"");
  out.measured_anywhere = where_measured != "static";
  out.measured_here = where_measured == "recording";
  return out;
}

Result<Definition::Point> read_point(io::TomlFields& fields) {
  Definition::Point out;
  fields.text("name", out.name, Need::required).flag("written", out.written).texts("also", out.also);
  fields.flag("regression", out.regression);
  if (auto s = take_trial(fields, out.trial); !s) return std::unexpected(s.error());
  if (auto s = take_formula(fields, "formula", out.formula); !s) return std::unexpected(s.error());
  return out;
}

Result<Definition::Landmark> read_landmark(io::TomlFields& fields) {
  Definition::Landmark out{.trial = "static"};
  fields.text("name", out.name, Need::required)
      .text("segment", out.segment, Need::required)
      .text("trial", out.trial)
      .flag("written", out.written);
  if (auto s = take_formula(fields, "formula", out.formula); !s) return std::unexpected(s.error());
  return out;
}

Result<Definition::Segment> read_segment(io::TomlFields& fields, const toml::table& table) {
  Definition::Segment out;
  fields.text("name", out.name, Need::required);
  if (auto s = take_trial(fields, out.trial); !s) return std::unexpected(s.error());
  if (auto s = take_formula(fields, "origin", out.origin); !s) return std::unexpected(s.error());
  if (auto s = take_direction(fields, "first", out.first, out.first_along); !s)
    return std::unexpected(s.error());
  if (auto s = take_direction(fields, "second", out.second, out.second_along); !s)
    return std::unexpected(s.error());
  const auto wrong = fail(Code::bad_input, fields.where() + ": turns: expected [[\"x\", \"FORMULA\"], ...]");
  if (!table.contains("turns")) return out;
  const auto* list = table["turns"].as_array();
  if (list == nullptr) return wrong;
  for (const auto& item : *list) {
    const auto* pair = item.as_array();
    if (pair == nullptr || pair->size() != 2) return wrong;
    const auto axis = axis_of((*pair)[0].value_or(std::string()));
    const auto text = (*pair)[1].value<std::string>();
    if (!axis || !text) return wrong;
    auto made = formula_of(*text, fields.where(), "turns");
    if (!made) return std::unexpected(made.error());
    out.turns.emplace_back(*axis, std::move(*made));
  }
  return out;
}

// ["dorsiflexion", "-y", -90]
Result<Definition::Component> read_component(const toml::node& node, const Definition::Angle& angle,
                                             const std::string& where) {
  const auto wrong =
      fail(Code::bad_input, where +
                                ": components: expected three of [\"LABEL\", \"-y\"] or [\"LABEL\", "
                                "\"-y\", DEGREES] with an axis that the sequence has once, or 1, 2, 3");
  const auto* list = node.as_array();
  if (list == nullptr || list->size() < 2 || list->size() > 3) return wrong;
  const auto label = (*list)[0].value<std::string>();
  auto axis = (*list)[1].value<std::string>();
  if (!label || label->empty() || !axis || axis->empty()) return wrong;
  Definition::Component out{.label = *label};
  if (axis->front() == '-' || axis->front() == '+') {
    out.sign = axis->front() == '-' ? -1.0 : 1.0;
    axis->erase(0, 1);
  }
  // An axis, which a sequence has once; or 1, 2, 3 in the order of the sequence.
  if (const auto of = axis_of(*axis)) {
    out.index = *of;
    if (!angle.helical) {
      if (std::ranges::count(angle.sequence, *of) != 1) return wrong;
      out.index = static_cast<int>(std::ranges::find(angle.sequence, *of) - angle.sequence.begin());
    }
  } else if (axis->size() == 1 && axis->front() >= '1' && axis->front() <= '3' && !angle.helical) {
    out.index = axis->front() - '1';
  } else {
    return wrong;
  }
  if (list->size() == 3) {
    const auto degrees = (*list)[2].value<double>();
    if (!degrees || !std::isfinite(*degrees)) return wrong;
    out.offset_rad = *degrees * std::numbers::pi / 180.0;
  }
  return out;
}

Result<Definition::Angle> read_angle(io::TomlFields& fields, const toml::table& table) {
  Definition::Angle out;
  std::string sequence;
  fields.text("name", out.name, Need::required)
      .text("parent", out.parent, Need::required)
      .text("child", out.child, Need::required)
      .text("sequence", sequence, Need::required)
      .flag("second_negative", out.second_negative)
      .flag("cross_talk", out.cross_talk);
  if (fields.failed()) return std::unexpected(fields.finish().error());
  out.helical = sequence == "helical";
  if (!out.helical) {
    const auto parsed = analysis::parse_sequence(sequence);
    if (!parsed)
      return fail(Code::bad_input,
                  fmt::format("{}: sequence: {}, or 'helical'", fields.where(), parsed.error().message));
    out.sequence = *parsed;
  }
  const auto* list = table["components"].as_array();
  if (list == nullptr || list->size() != 3)
    return fail(Code::bad_input, fields.where() + ": needs three components");
  for (std::size_t k = 0; k < 3; ++k) {
    auto component = read_component((*list)[k], out, fields.where());
    if (!component) return std::unexpected(component.error());
    out.components[k] = std::move(*component);
  }
  return out;
}

Result<Definition::Value> read_value(io::TomlFields& fields) {
  Definition::Value out;
  fields.text("name", out.name, Need::required);
  take_quantity(fields, out.quantity);
  if (auto s = take_formula(fields, "formula", out.formula); !s) return std::unexpected(s.error());
  return out;
}

Status take_entry(std::string_view kind, const toml::table& table, const std::string& where,
                  Definition& out) {
  const auto name = table["name"].value_or(std::string());
  toml::table plain = table;  // without the lists of lists, which are read here
  if (kind == "segment") plain.erase("turns");
  if (kind == "angle") plain.erase("components");
  if (kind == "joint") {
    plain.erase("moment");
    plain.erase("force");
  }
  io::TomlFields fields(plain, fmt::format("{}: {} '{}'", where, kind, name));
  const auto add = [&](auto& list, auto read) -> Status {
    if (fields.failed()) return fields.finish();
    if (!read) return std::unexpected(read.error());
    if (auto s = fields.finish(); !s) return s;
    list.push_back(std::move(*read));
    return {};
  };
  // A field that is wrong comes before what follows from it.
  if (kind == "parameter") {
    auto read = read_parameter(fields);
    return add(out.parameters, std::move(read));
  }
  if (kind == "point") {
    auto read = read_point(fields);
    return add(out.points, std::move(read));
  }
  if (kind == "landmark") {
    auto read = read_landmark(fields);
    return add(out.landmarks, std::move(read));
  }
  if (kind == "segment") {
    auto read = read_segment(fields, table);
    return add(out.segments, std::move(read));
  }
  if (kind == "angle") {
    auto read = read_angle(fields, table);
    return add(out.angles, std::move(read));
  }
  if (kind == "body") {
    auto read = internal::read_body(fields);
    return add(out.bodies, std::move(read));
  }
  if (kind == "joint") {
    auto read = internal::read_joint(fields, table);
    return add(out.joints, std::move(read));
  }
  auto read = read_value(fields);
  return add(out.values, std::move(read));
}

Status take_entries(std::string_view kind, const toml::array& list, const std::string& name,
                    const std::vector<Side>& sides, Definition& out) {
  for (const auto& item : list) {
    const auto* table = item.as_table();
    if (table == nullptr)
      return fail(Code::bad_input, fmt::format("{}: {}: expected [[{}]] tables", name, kind, kind));
    bool braces = false;
    for (const auto& side : sides) {
      toml::table made = *table;
      braces = write_for_side(made, side);
      if (!braces) break;
      if (auto s = take_entry(kind, made, name, out); !s) return s;
    }
    if (braces) continue;
    if (auto s = take_entry(kind, *table, name, out); !s) return s;
  }
  return {};
}

Status read_progression(const toml::table& table, const std::string& name, Definition& out) {
  io::TomlFields fields(table, name + ": progression");
  Formula point, facing;
  if (auto s = take_formula(fields, "point", point); !s) return s;
  if (auto s = take_formula(fields, "facing", facing); !s) return s;
  if (auto s = fields.finish(); !s) return s;
  out.progression.emplace(std::move(point), std::move(facing));
  return {};
}

}  // namespace

Result<Definition> parse_definition(std::string_view text, const std::string& name) {
  const auto parsed = io::parse_toml(text, name);
  if (!parsed) return std::unexpected(parsed.error());
  const toml::table& root = *parsed;
  Definition out;
  const auto sides = read_sides(root, name);
  if (!sides) return std::unexpected(sides.error());
  for (const auto& [key, node] : root) {
    const std::string_view kind = key.str();
    if (kind == "sides") continue;
    if (kind == "title") {
      out.title = node.value_or(std::string());
      continue;
    }
    if (kind == "angular_span") {
      const auto span = node.value<std::int64_t>();
      if (!span || *span < 0 || *span > 2)
        return fail(Code::bad_input, name + ": angular_span: expected 0, 1 or 2 frames");
      out.angular_span = *span;
      continue;
    }
    if (kind == "progression" && node.is_table()) {
      if (auto s = read_progression(*node.as_table(), name, out); !s) return std::unexpected(s.error());
      continue;
    }
    const bool known = kind == "parameter" || kind == "point" || kind == "landmark" || kind == "segment" ||
                       kind == "angle" || kind == "value" || kind == "body" || kind == "joint";
    if (!known || !node.is_array())
      return fail(Code::bad_input,
                  fmt::format("{}: '{}' is not read; there are title, sides, angular_span, [progression], "
                              "[[parameter]], [[point]], "
                              "[[landmark]], [[segment]], [[angle]], [[value]], [[body]] and [[joint]]",
                              name, kind));
    if (auto s = take_entries(kind, *node.as_array(), name, *sides, out); !s)
      return std::unexpected(s.error());
  }
  if (auto s = out.check(); !s) return fail_at(name, s.error());
  return out;
}

Result<Definition> read_definition(const std::filesystem::path& path) {
  const auto text = io::read_text(path, kMostBytes);
  if (!text) return std::unexpected(text.error());
  return parse_definition(*text, path.string());
}

std::vector<ShippedDefinition> shipped_definitions() {
  return {{"pig", internal::pig_text()}, {"isb-shoulder", internal::isb_shoulder_text()}};
}

Result<Definition> find_definition(const std::string& name_or_path) {
  std::vector<std::string_view> names;
  for (const auto& shipped : shipped_definitions()) {
    if (shipped.name == name_or_path) return parse_definition(shipped.text, std::string(shipped.name));
    names.push_back(shipped.name);
  }
  if (std::filesystem::path(name_or_path).extension().empty() && !std::filesystem::exists(name_or_path))
    return fail(Code::usage, fmt::format("'{}' is no definition of segments; expected {} or a .toml file",
                                         name_or_path, fmt::join(names, ", ")));
  return read_definition(name_or_path);
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/table_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"

namespace kinemark::analysis {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi, kTurn_deg = 360.0;
constexpr double kMostTurns = 2.0;
constexpr std::size_t kFewestTurned = 4, kMostNamed = 3;
// Parts of names of columns that hold no angle.
constexpr std::array<std::string_view, 16> kOthers{
    "force",      "torque", "moment", "power",  "emg",          "activation", "speed", "reserve",
    "excitation", "length", "marker", "weight", "acceleration", "velocity",   "grf",   "_tau"};

std::string lowered(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// Whether a name can be that of an angle: no translation, no component of a vector, nothing of kOthers.
bool may_turn(std::string_view column) {
  auto name = lowered(column);
  if (name.ends_with("/value")) name.resize(name.size() - std::string_view("/value").size());
  if (std::ranges::any_of(kOthers, [&](std::string_view part) { return name.find(part) != name.npos; }))
    return false;
  const auto axis = name.empty() ? ' ' : name.back();
  if (axis < 'x' || axis > 'z') return true;
  const auto before = std::string_view(name).substr(0, name.size() - 1);
  return before.ends_with("_r") || before.ends_with("_rot_") || before.ends_with("rot");
}

struct Column {
  std::string name;
  double least = kNaN, most = kNaN;
};

std::vector<Column> angles_of(const data::Table& table) {
  std::vector<Column> out;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!may_turn(table.columns[c])) continue;
    Column column{.name = table.columns[c]};
    for (std::int64_t r = 0; r < table.rows(); ++r) {
      const double value = table(r, static_cast<std::int64_t>(c));
      column.least = std::fmin(column.least, value), column.most = std::fmax(column.most, value);
    }
    out.push_back(std::move(column));
  }
  return out;
}

std::string below_zero(const data::Table& table) {
  std::vector<std::string> names;
  std::int64_t count = 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::int64_t in_column = 0;
    for (std::int64_t r = 0; r < table.rows(); ++r) in_column += table(r, static_cast<std::int64_t>(c)) < 0.0;
    if (in_column > 0) names.push_back(table.columns[c]);
    count += in_column;
  }
  if (names.empty()) return {};
  return fmt::format("{} cells hold a negative standard deviation, of {}: that is none", count,
                     join_some(names, kMostNamed));
}

std::string called_radians(const std::vector<Column>& angles) {
  std::vector<std::string> names;
  for (const auto& one : angles)
    if (one.least < -kTurn_rad || one.most > kTurn_rad) names.push_back(one.name);
  if (names.size() < kFewestTurned) return {};
  return fmt::format(
      "the file says inDegrees=no, but {} angles lie beyond a whole turn as radians, {} among them: if they "
      "are "
      "degrees, write inDegrees=yes above endheader",
      names.size(), join_some(names, kMostNamed));
}

}  // namespace

std::vector<std::string> contradicted_values(const data::Table& table, const std::string& file_name) {
  std::vector<std::string> out;
  if (file_name.ends_with("_sd.sto") || lowered(table.name).starts_with("standard deviation")) {
    if (auto said = below_zero(table); !said.empty()) out.push_back(std::move(said));
    return out;
  }
  if (!table.degrees_stated) return out;
  const auto angles = angles_of(table);
  if (!table.in_degrees)
    if (auto said = called_radians(angles); !said.empty()) return {std::move(said)};
  const double turn = table.in_degrees ? kTurn_deg : kTurn_rad;
  for (const auto& one : angles)
    if (one.most - one.least > kMostTurns * turn)
      out.push_back(fmt::format(
          "'{}' turns by {:.0f} deg between {:.4g} and {:.4g} {}: no joint does, and a body only if it spins",
          one.name, (one.most - one.least) / turn * kTurn_deg, one.least, one.most,
          table.in_degrees ? "deg" : "rad"));
  return out;
}

}  // namespace kinemark::analysis

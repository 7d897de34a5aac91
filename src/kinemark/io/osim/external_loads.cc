// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/external_loads.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>

#include "kinemark/core/missing.h"
#include "kinemark/io/osim/internal/ik_tasks_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using osim::in_quotes;
using osim::text_of;
using osim::XmlFile;

/// An element's text; "Unassigned" is none.
std::string word_of(pugi::xml_node node, const char* child) {
  std::string text = text_of(node, child);
  return text == "Unassigned" ? std::string() : text;
}

/// "/bodyset/calcn_r" -> "calcn_r".
std::string body_of(pugi::xml_node node, const char* child) {
  const std::string path = word_of(node, child);
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

void read_force(XmlFile& file, pugi::xml_node node, std::vector<ExternalForce>& forces) {
  // Files of OpenSim 4 say <appliesForce>, those before <isDisabled>.
  if (!file.flag(node, "appliesForce", true) || file.flag(node, "isDisabled", false)) return;
  ExternalForce force{.name = osim::name_of(node),
                      .body = body_of(node, "applied_to_body"),
                      .force = word_of(node, "force_identifier"),
                      .point = word_of(node, "point_identifier"),
                      .torque = word_of(node, "torque_identifier")};
  if (force.name.empty()) force.name = force.body;
  if (force.body.empty()) file.note(node, "names no <applied_to_body>");
  if (force.force.empty() && force.torque.empty())
    file.note(node, "has neither <force_identifier> nor <torque_identifier>");
  if (!force.force.empty() && force.point.empty())
    file.note(node, "has a force but no <point_identifier>; need the columns of the point where it acts",
              Code::not_supported);
  for (const char* frame : {"force_expressed_in_body", "point_expressed_in_body"}) {
    const std::string body = body_of(node, frame);
    const bool asked = std::string_view(frame).starts_with("force") || !force.point.empty();
    if (asked && !body.empty() && body != "ground")
      file.note(node.child(frame),
                fmt::format("is {}; only forces and points in ground are read", in_quotes(body)),
                Code::not_supported);
  }
  forces.push_back(std::move(force));
}

Result<ExternalLoads> read_loads(XmlFile& file, const std::filesystem::path& folder) {
  const pugi::xml_node set = file.find_object({"ExternalLoads"});
  if (!set)
    return fail(Code::bad_input, fmt::format("{}: has no <ExternalLoads>; its first element is <{}>",
                                             file.name(), file.document().name()));
  ExternalLoads loads{
      .source = file.name(), .data_file = osim::path_of(set, "datafile", folder), .forces = {}};
  for (const pugi::xml_node node : set.child("objects").children("ExternalForce"))
    read_force(file, node, loads.forces);
  if (file.error()) return std::unexpected(*file.error());
  if (loads.forces.empty())
    return fail(Code::bad_input, fmt::format("{}: no <ExternalForce> is switched on", file.name()));
  if (loads.data_file.empty())
    return fail(Code::bad_input, fmt::format("{}: names no <datafile>", file.name()));
  return loads;
}

using Columns = std::array<std::int64_t, 3>;

/// The three columns that an identifier stands for: with x, y, z or 1, 2, 3 behind it, else the only three
/// whose names begin with it, in the order of the file.
Result<Columns> find_columns(const ExternalLoads& loads, const ExternalForce& force, const data::Table& table,
                             const std::string& identifier) {
  for (const char* ends : {"xyz", "XYZ", "123"})
    for (const char* joint : {"", "_", "."}) {
      Columns columns{};
      for (std::size_t i = 0; i < 3; ++i) columns[i] = table.find(identifier + joint + ends[i]);
      if (std::ranges::min(columns) >= 0) return columns;
    }
  std::vector<std::int64_t> found;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].starts_with(identifier)) found.push_back(static_cast<std::int64_t>(c));
  if (found.size() == 3) return Columns{found[0], found[1], found[2]};
  return fail(
      Code::bad_input,
      fmt::format(
          "{}: ExternalForce '{}' asks for columns that begin with '{}'; {} has {} of them, need three",
          loads.source, force.name, identifier, loads.data_file.string(), found.size()));
}

/// Whether a table has a column for each axis behind these words.
bool has_three(const data::Table& table, const std::string& words) {
  return std::ranges::all_of(std::string_view("xyz"),
                             [&](char axis) { return table.find(words + axis) >= 0; });
}

/// The columns' name with another word for "force"; the same with "torque" behind it where it has none.
std::string with(std::string base, std::string_view word) {
  const auto at = base.rfind("force");
  return at == std::string::npos ? base + std::string(word) + "_" : base.replace(at, 5, word);
}

/// The values of one row.
struct Row {
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero(), point = Vector3d::Zero();

  [[nodiscard]] bool rests() const { return force.isZero(0.0) && torque.isZero(0.0); }
};

/// Columns of one force.
struct Source {
  std::optional<Columns> force, point, torque;

  [[nodiscard]] Row row(const data::Table& table, std::int64_t r) const {
    const auto triple = [&](const std::optional<Columns>& columns) -> Vector3d {
      if (!columns) return Vector3d::Zero();
      return {table(r, (*columns)[0]), table(r, (*columns)[1]), table(r, (*columns)[2])};
    };
    Row row{triple(force), triple(torque), triple(point)};
    if (row.rests()) row.point.setConstant(kNaN);
    return row;
  }
};

/// A point between two rows; where nothing acts in one of them, that of the other.
Vector3d between(const Row& a, const Row& b, double later) {
  if (a.rests()) return b.point;
  if (b.rests()) return a.point;
  return (1.0 - later) * a.point + later * b.point;
}

void append(Array<double>& values, const Vector3d& v) { values.insert(values.end(), v.data(), v.data() + 3); }

data::Wrench sample(const ExternalForce& force, const Source& source, const data::Table& table,
                    const TimeBase& time) {
  data::Wrench wrench{.name = force.name, .body = force.body, .force = {}, .moment = {}, .point = {}};
  // Times are computed from rates; a frame may miss the first or last row by rounding.
  const double slack = 1e-6 / time.rate_hz;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double t = time.time_s(f);
    Row now{Vector3d::Constant(kNaN), Vector3d::Constant(kNaN), Vector3d::Constant(kNaN)};
    if (table.rows() > 0 && t >= table.time_s.front() - slack && t <= table.time_s.back() + slack) {
      const auto next = std::ranges::upper_bound(table.time_s, t);
      const std::int64_t after = std::clamp<std::int64_t>(
          next - table.time_s.begin(), std::min<std::int64_t>(1, table.rows() - 1), table.rows() - 1);
      const std::int64_t before = std::max<std::int64_t>(0, after - 1);
      const double begin = table.time_s[static_cast<std::size_t>(before)],
                   end = table.time_s[static_cast<std::size_t>(after)];
      const double later = end > begin ? std::clamp((t - begin) / (end - begin), 0.0, 1.0) : 0.0;
      // A frame that coincides with a row does not use the next row, which may be blank.
      const Row a = source.row(table, later < 1.0 ? before : after),
                b = later > 0.0 ? source.row(table, after) : a;
      now.force = (1.0 - later) * a.force + later * b.force;
      now.torque = (1.0 - later) * a.torque + later * b.torque;
      now.point = between(a, b, later);
      const bool known = now.force.allFinite() && now.torque.allFinite();
      if (!known || (!now.rests() && !now.point.allFinite()))
        now = {Vector3d::Constant(kNaN), Vector3d::Constant(kNaN), Vector3d::Constant(kNaN)};
    }
    append(wrench.force, now.force);
    append(wrench.moment, now.torque);
    append(wrench.point, now.point);
  }
  return wrench;
}

}  // namespace

Result<ExternalLoads> read_external_loads(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  return read_loads(*file, path.parent_path());
}

Result<ExternalLoads> parse_external_loads(std::string_view xml, std::string name,
                                           const std::filesystem::path& folder) {
  auto file = XmlFile::parse(xml, std::move(name));
  if (!file) return std::unexpected(file.error());
  return read_loads(*file, folder);
}

Result<ExternalLoads> loads_of_columns(const data::Table& table, const std::filesystem::path& path) {
  ExternalLoads loads{.source = path.string(), .data_file = path, .forces = {}};
  for (const auto& column : table.columns) {
    if (!column.ends_with("vx")) continue;
    const std::string base = column.substr(0, column.size() - 2);
    if (!has_three(table, base + "v") || !has_three(table, base + "p")) continue;
    ExternalForce force{.name = base, .body = "", .force = base + "v", .point = base + "p", .torque = {}};
    while (force.name.ends_with('_')) force.name.pop_back();
    if (force.name.empty()) force.name = fmt::format("force {}", loads.forces.size() + 1);
    for (const auto& moment : {with(base, "torque"), with(base, "moment"), base + "m"})
      if (force.torque.empty() && has_three(table, moment)) force.torque = moment;
    loads.forces.push_back(std::move(force));
  }
  if (loads.forces.empty())
    return fail(Code::bad_input,
                fmt::format("{}: has no columns of forces; need NAMEvx, NAMEvy, NAMEvz and NAMEpx, NAMEpy, "
                            "NAMEpz, such as ground_force_vx and ground_force_px",
                            path.string()));
  return loads;
}

data::Table table_of_forces(const data::Wrenches& wrenches) {
  data::Table table{.name = "ground reactions"};
  for (std::int64_t f = 0; f < wrenches.frames(); ++f) table.time_s.push_back(wrenches.time.time_s(f));
  for (std::size_t i = 0; i < wrenches.items.size(); ++i)
    for (const char* words : {"ground_force_v", "ground_force_p", "ground_torque_"})
      for (const char axis : {'x', 'y', 'z'})
        table.columns.push_back(fmt::format("{}_{}{}", i + 1, words, axis));
  for (std::size_t row = 0; row < table.time_s.size(); ++row)
    for (const auto& wrench : wrenches.items) {
      const auto append = [&](const Array<double>& values, bool known) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          table.values.push_back(known ? values[3 * row + axis] + 0.0 : 0.0);  // no -0
      };
      const bool acts = !(wrench.force[3 * row] == 0.0 && wrench.force[3 * row + 1] == 0.0 &&
                          wrench.force[3 * row + 2] == 0.0);
      append(wrench.force, true);
      append(wrench.point, acts);
      append(wrench.moment, acts);
    }
  return table;
}

Result<data::Wrenches> sample_external_loads(const ExternalLoads& loads, const data::Table& table,
                                             const TimeBase& time) {
  data::Wrenches wrenches{.time = time, .items = {}};
  for (const ExternalForce& force : loads.forces) {
    Source source;
    for (const auto& [identifier, columns] : {std::pair{&force.force, &source.force},
                                              {&force.point, &source.point},
                                              {&force.torque, &source.torque}}) {
      if (identifier->empty()) continue;
      const auto found = find_columns(loads, force, table, *identifier);
      if (!found) return std::unexpected(found.error());
      *columns = *found;
    }
    wrenches.items.push_back(sample(force, source, table, time));
  }
  return wrenches;
}

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/d_flow_forces.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/coordinate_labels.h"
#include "kinemark/io/text/internal/marker_rows.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using internal::Cell;
using internal::Cells;
using internal::Lines;
using internal::Separator;
using Columns = std::array<std::size_t, 3>;

/// The columns of a plate.
struct Plate {
  int number = 1;
  Columns force{}, point{};
  std::optional<Columns> moment;
};

struct Header {
  std::size_t time = 0, width = 0;
  std::vector<Plate> plates;
};

std::optional<Columns> three(const std::vector<std::string>& labels, const std::string& words) {
  Columns out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = std::ranges::find(labels, words + "XYZ"[axis]);
    if (at == labels.end()) return std::nullopt;
    out[axis] = static_cast<std::size_t>(at - labels.begin());
  }
  return out;
}

std::vector<Plate> plates_of(const std::vector<std::string>& labels) {
  constexpr int kMostPlates = 32;
  std::vector<Plate> out;
  for (int number = 1; number <= kMostPlates; ++number) {
    const auto words = [&](const char* what) { return fmt::format("FP{}.{}", number, what); };
    const auto force = three(labels, words("For")), point = three(labels, words("Cop"));
    if (force && point) out.push_back({number, *force, *point, three(labels, words("Mom"))});
  }
  return out;
}

std::optional<Header> read_header(Lines& lines) {
  std::string_view line;
  std::vector<std::string> labels;
  if (!lines.next(line) || !internal::check_header_line(line, 1) || !internal::split_labels(line, labels))
    return std::nullopt;
  Header out{.width = labels.size()};
  const auto time = std::ranges::find_if(labels, [](const std::string& label) {
    return internal::coordinate_label(label).units_per_second == 1.0;
  });
  if (time == labels.end()) return std::nullopt;
  out.time = static_cast<std::size_t>(time - labels.begin());
  out.plates = plates_of(labels);
  if (out.plates.empty()) return std::nullopt;
  return out;
}

/// Rows of numbers up to a blank line, a cell of the labels each; what is no number is NaN.
Status read_rows(Lines& lines, const Header& header, Array<double>& times, Array<double>& cells) {
  std::string_view line;
  std::string buffer;
  std::vector<double> row(header.width);
  while (lines.next(line) && !internal::is_blank(line)) {
    buffer.assign(line);
    if (line.find('\t') == std::string_view::npos) std::ranges::replace(buffer, ',', '\t');
    Cells walk(buffer, Separator::tab);
    std::ranges::fill(row, kNaN);
    for (double& value : row)
      if (double number = kNaN; walk.next(number) == Cell::number) value = number;
    const double time_s = row[header.time];
    if (!std::isfinite(time_s) || (!times.empty() && time_s <= times.back()))
      return fail(Code::bad_input,
                  fmt::format("line {}: the time is no number or does not increase", lines.number()));
    times.push_back(time_s);
    for (const auto& plate : header.plates)
      for (const auto& columns : {plate.force, plate.point, plate.moment.value_or(plate.force)})
        for (const std::size_t c : columns) cells.push_back(row[c]);
  }
  if (times.empty())
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends before the first row of data", lines.number() + 1));
  return {};
}

/// One plate over the rows.
class Loads {
 public:
  Loads(const Array<double>& cells, std::size_t plate, std::size_t plates)
      : cells_(cells), first_(9 * plate), step_(9 * plates) {}

  [[nodiscard]] std::size_t rows() const { return cells_.size() / step_; }
  [[nodiscard]] Vector3d force(std::size_t row) const { return at(row, 0); }
  [[nodiscard]] Vector3d point(std::size_t row) const { return at(row, 3); }
  [[nodiscard]] Vector3d moment(std::size_t row) const { return at(row, 6); }

 private:
  [[nodiscard]] Vector3d at(std::size_t row, std::size_t offset) const {
    return Eigen::Map<const Vector3d>(cells_.data() + row * step_ + first_ + offset);
  }
  const Array<double>& cells_;
  std::size_t first_, step_;
};

/// Sum of all forces that are numbers, by their size: light and noisy ones hardly count.
Vector3d push_of(const std::vector<Loads>& plates) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& plate : plates)
    for (std::size_t row = 0; row < plate.rows(); ++row)
      if (const Vector3d f = plate.force(row); (f.array().abs() < 1e6).all()) sum += f.norm() * f;
  return sum;
}

enum class About : std::uint8_t { origin, point, unknown };

/// What the moments of a plate are about: the one that leaves hardly anything across the vertical.
About moments_about(const Loads& plate, Eigen::Index up, double contact_force_n) {
  constexpr double kFree = 0.1;  // of the moment of the force about the origin
  double by_force = 0.0, stated = 0.0, rest = 0.0;
  for (std::size_t row = 0; row < plate.rows(); ++row) {
    const Vector3d f = plate.force(row), m = plate.moment(row);
    Vector3d of_force = plate.point(row).cross(f);
    if (!of_force.allFinite() || !m.allFinite() || std::abs(f[up]) < std::max(contact_force_n, 1.0)) continue;
    Vector3d across = m, left = m - of_force;
    across[up] = left[up] = of_force[up] = 0.0;
    by_force += of_force.norm();
    stated += across.norm();
    rest += left.norm();
  }
  if (rest < kFree * by_force) return About::origin;
  return stated < kFree * by_force ? About::point : About::unknown;
}

void append(Array<double>& values, const Vector3d& v) { values.insert(values.end(), v.data(), v.data() + 3); }

}  // namespace

std::vector<std::string> d_flow_force_labels(const std::vector<std::string>& labels) {
  std::vector<std::string> out;
  for (const auto& plate : plates_of(labels))
    for (const auto& columns : {plate.force, plate.point, plate.moment.value_or(plate.force)})
      for (const std::size_t c : columns) out.push_back(labels[c]);
  return out;
}

bool begins_d_flow_forces(std::string_view begin) {
  Lines lines(begin);
  return read_header(lines).has_value();
}

Result<data::Table> parse_d_flow_forces(std::string_view text, std::string_view name,
                                        double contact_force_n) {
  Lines lines(text);
  const auto header = read_header(lines);
  if (!header)
    return fail(
        Code::bad_input,
        fmt::format("{}: labels no forces of D-Flow; need a time, FP1.ForX, FP1.ForY, FP1.ForZ and FP1.CopX, "
                    "FP1.CopY, FP1.CopZ",
                    name));
  data::Table table{.name = "forces of D-Flow", .in_degrees = false, .degrees_stated = true};
  Array<double> cells;
  if (auto s = read_rows(lines, *header, table.time_s, cells); !s) return fail_at(name, s.error());
  std::vector<Loads> plates;
  for (std::size_t p = 0; p < header->plates.size(); ++p)
    plates.emplace_back(cells, p, header->plates.size());
  const Vector3d push = push_of(plates);
  Eigen::Index up = 0;
  push.cwiseAbs().maxCoeff(&up);
  const double sign = push[up] < 0.0 ? -1.0 : 1.0;
  if (sign < 0.0)
    table.warnings.emplace_back(
        "forces of D-Flow are those of the body on the plates; their sign was reversed");
  std::vector<About> about;
  for (std::size_t p = 0; p < plates.size(); ++p) {
    const auto& plate = header->plates[p];
    for (const char* words : {"_v", "_p", "_m"})
      for (const char axis : {'x', 'y', 'z'})
        table.columns.push_back(fmt::format("plate {}{}{}", plate.number, words, axis));
    about.push_back(plate.moment ? moments_about(plates[p], up, contact_force_n) : About::unknown);
    if (plate.moment && about.back() == About::unknown)
      table.warnings.push_back(
          fmt::format("plate {}: its moments (FP{}.MomX) are neither about the origin nor about the point of "
                      "the force; its free "
                      "moment is taken as 0",
                      plate.number, plate.number));
  }
  for (std::size_t row = 0; row < table.time_s.size(); ++row)
    for (std::size_t p = 0; p < plates.size(); ++p) {
      const Vector3d force = sign * plates[p].force(row), point = plates[p].point(row);
      const bool acts = !(std::abs(force[up]) < std::max(contact_force_n, 1.0));  // NaN acts
      Vector3d moment = Vector3d::Zero();
      if (about[p] != About::unknown) moment = sign * plates[p].moment(row);
      if (about[p] == About::origin) moment -= point.cross(force);
      append(table.values, acts ? force : Vector3d(Vector3d::Zero()));
      append(table.values, acts ? point : Vector3d(Vector3d::Zero()));
      append(table.values, acts ? moment : Vector3d(Vector3d::Zero()));
    }
  table.warnings.push_back(
      fmt::format("forces of {} plate{} are those of D-Flow (N, points in m); where the plates lie is not "
                  "known (it writes no "
                  "corners), so nothing is said of feet beside them",
                  plates.size(), plates.size() == 1 ? "" : "s"));
  return table;
}

Result<data::Table> read_d_flow_forces(const std::filesystem::path& path, double contact_force_n) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_d_flow_forces(*text, path.string(), contact_force_n);
}

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/orientation_csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/internal/quaternion_rows.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text/internal/vendor_headers.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::Lines;
using Row = std::vector<std::string>;

constexpr std::string_view kMotive = "Format Version,";
constexpr std::string_view kParts = "wxyz";
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Which columns hold what.
struct Layout {
  std::vector<std::string> names;                 ///< S
  std::vector<std::array<std::size_t, 4>> cells;  ///< S, columns of w x y z
  std::size_t time = kNone, frame = kNone;
  std::vector<double> rates_hz;
  std::size_t unread = 0;  ///< columns of other things
  std::size_t last = 0;    ///< the last column that is read
  std::map<std::string, std::size_t> index;

  /// The number `part` (in kParts) of a name stands in this column.
  void add(const std::string& name, std::size_t part, std::size_t column) {
    const auto [place, is_new] = index.try_emplace(name, names.size());
    if (is_new) {
      names.push_back(name);
      cells.push_back({kNone, kNone, kNone, kNone});
    }
    auto& one = cells[place->second][part];
    if (one == kNone) one = column;
    last = std::max(last, column);
  }
  [[nodiscard]] bool is_whole() const {
    return !names.empty() && std::ranges::all_of(cells, [](const auto& four) {
      return std::ranges::find(four, kNone) == four.end();
    });
  }
};

std::string cell(const Row& row, std::size_t column) {
  return column < row.size() ? row[column] : std::string();
}

/// Labels of a table of quaternions; nothing where they are others.
std::optional<Layout> layout_of_labels(const Row& labels) {
  Layout out;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::string& label = labels[c];
    const std::string lower = internal::lower(label);
    const auto part = lower.empty() ? std::string_view::npos : kParts.find(lower.back());
    if (lower == "time" && out.time == kNone)
      out.time = c;
    else if (label.size() > 2 && label[label.size() - 2] == '_' && part != std::string_view::npos)
      out.add(name_of_bytes(label.substr(0, label.size() - 2)), part, c);
    else
      ++out.unread;
  }
  if (out.time == kNone || !out.is_whole()) return std::nullopt;
  return out;
}

bool is_solved(std::string_view type) { return type == "Rigid Body" || type == "Bone"; }

Layout layout_of_motive(const internal::MotiveRows& rows) {
  Layout out;
  out.frame = 0;
  if (internal::lower(cell(rows.axis, 1)).starts_with("time")) out.time = 1;
  for (std::size_t c = 1; c < rows.axis.size(); ++c) {
    const std::string axis = internal::lower(rows.axis[c]);
    const auto part = axis.size() == 1 ? kParts.find(axis) : std::string_view::npos;
    if (is_solved(cell(rows.type, c)) && cell(rows.component, c) == "Rotation" &&
        part != std::string_view::npos)
      out.add(name_of_bytes(cell(rows.name, c)), part, c);
  }
  return out;
}

Result<Layout> parse_motive_layout(Lines& lines, data::Trial& said) {
  internal::MarkerColumns columns;
  const auto rows = internal::parse_motive_rows(lines, columns, said);
  if (!rows) return std::unexpected(rows.error());
  auto out = layout_of_motive(*rows);
  out.rates_hz = columns.rates_hz;
  if (out.names.empty())
    return fail(Code::bad_input,
                fmt::format("line {}: no column is the rotation of a rigid body or a bone", rows->name_line));
  if (!out.is_whole())
    return fail(Code::not_supported,
                fmt::format("line {}: rotations have no columns X, Y, Z and W; export them "
                            "as quaternions",
                            rows->name_line));
  return out;
}

Result<Layout> parse_table_layout(Lines& lines) {
  std::string_view line;
  Row labels;
  if (lines.next(line))
    if (auto s = internal::check_header_line(line, lines.number()); !s) return std::unexpected(s.error());
  auto out = internal::split_csv(line, labels) ? layout_of_labels(labels) : std::nullopt;
  if (!out)
    return fail(Code::bad_input,
                "line 1: expected the labels time, then NAME_w, NAME_x, NAME_y and NAME_z of each sensor");
  return std::move(*out);
}

/// Rows below the header, up to a blank one or the end.
class RowReader {
 public:
  RowReader(const Layout& layout, internal::QuaternionRows& rows) : layout_(layout), rows_(rows) {}

  Status read(Lines& lines) {
    std::string_view line;
    Row cells;
    while (lines.next(line) && !internal::is_blank(line)) {
      if (!internal::split_csv(line, cells))
        return fail(Code::bad_input, fmt::format("line {}: a quote is not closed", lines.number()));
      if (cells.size() <= layout_.last)
        return fail(Code::bad_input, fmt::format("line {}: {} cells; expected {} or more", lines.number(),
                                                 cells.size(), layout_.last + 1));
      if (auto s = read_time(cells, lines.number()); !s) return s;
      for (std::size_t s = 0; s < layout_.cells.size(); ++s)
        if (auto status = read_quaternion(cells, s, lines.number()); !status) return status;
      line_of_row_.push_back(lines.number());
    }
    if (std::isfinite(resolution_s_)) rows_.resolution_s = resolution_s_;
    rows_.place = [lines_of = line_of_row_](std::size_t row) {
      return fmt::format("line {}", lines_of[row]);
    };
    return {};
  }

 private:
  Status read_time(const Row& cells, std::int64_t line) {
    const bool has_time = layout_.time != kNone;
    const auto text = cell(cells, has_time ? layout_.time : layout_.frame);
    const auto number = parse_number(text);
    if (!number || !std::isfinite(*number))
      return fail(Code::bad_input, fmt::format("line {}: the {} is '{}'; expected a number", line,
                                               has_time ? "time" : "frame", internal::excerpt(text)));
    if (!has_time && layout_.rates_hz.empty())
      return fail(Code::bad_input, "the header states no frame rate and the rows hold no times");
    rows_.time_s.push_back(has_time ? *number : *number / layout_.rates_hz.front());
    if (has_time && *number != 0.0) resolution_s_ = std::min(resolution_s_, internal::resolution_of(text));
    return {};
  }

  Status read_quaternion(const Row& cells, std::size_t sensor, std::int64_t line) {
    std::array<double, 4> q{};
    bool missing = false;
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto text = cell(cells, layout_.cells[sensor][k]);
      const auto number = parse_number(text);
      if (!number && !text.empty())
        return fail(Code::bad_input, fmt::format("line {}, column {}: '{}' is no number", line,
                                                 layout_.cells[sensor][k] + 1, internal::excerpt(text)));
      missing = missing || !number || !std::isfinite(*number);
      q[k] = number.value_or(kNaN);
    }
    if (missing) q.fill(kNaN);
    rows_.values.insert(rows_.values.end(), q.begin(), q.end());
    return {};
  }

  const Layout& layout_;
  internal::QuaternionRows& rows_;
  std::vector<std::int64_t> line_of_row_;
  double resolution_s_ = std::numeric_limits<double>::infinity();
};

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

Result<data::Orientations> parse(std::string_view text) {
  Lines lines(text);
  data::Trial said;  // what the header of Motive says besides
  const bool is_motive = without_mark(text).starts_with(kMotive);
  const auto layout = is_motive ? parse_motive_layout(lines, said) : parse_table_layout(lines);
  if (!layout) return std::unexpected(layout.error());
  internal::QuaternionRows rows;
  rows.names = layout->names;
  rows.rates_hz = layout->rates_hz;
  if (layout->unread > 0) rows.warnings.push_back(fmt::format("{} columns are not read", layout->unread));
  if (auto s = RowReader(*layout, rows).read(lines); !s) return std::unexpected(s.error());
  return internal::settle_quaternions(std::move(rows));
}

}  // namespace

bool begins_orientation_csv(std::string_view begin) {
  Lines lines(begin);
  if (without_mark(begin).starts_with(kMotive)) {
    internal::MarkerColumns columns;
    data::Trial said;
    const auto rows = internal::parse_motive_rows(lines, columns, said);
    return rows && !layout_of_motive(*rows).names.empty();
  }
  std::string_view line;
  Row labels;
  return lines.next(line) && line.size() < begin.size() && internal::split_csv(line, labels) &&
         layout_of_labels(labels).has_value();
}

Result<data::Orientations> parse_orientation_csv(std::string_view text, std::string_view name) {
  auto out = parse(text);
  if (!out) return fail_at(name, out.error());
  return out;
}

Result<data::Orientations> read_orientation_csv(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_orientation_csv(*text, path.string());
}

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/nwb/internal/pickled.h"
#include "kinemark/io/nwb/internal/pose_reader.h"

namespace kinemark::io::internal {
namespace {

using Columns = std::vector<std::vector<std::string>>;

/// Where a name is in a list, which gets it where it is new.
std::size_t place_of(const std::string& name, std::map<std::string, std::size_t>& known,
                     std::vector<std::string>& names) {
  const auto [at, is_new] = known.try_emplace(name, names.size());
  if (is_new) names.push_back(name);
  return at->second;
}

std::optional<std::size_t> coordinate_of(const std::string& name) {
  constexpr std::array<const char*, 3> kCoords = {"x", "y", "likelihood"};
  const auto found = std::ranges::find(kCoords, name);
  return found == kCoords.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(found - kCoords.begin()));
}

/// What `format="table"` writes: records with an index and one block of values.
Result<PoseTable> read_records(Input& in, hid_t table) {
  const auto pickle = in.text_attribute(table, "values_block_0_kind");
  if (!pickle)
    return fail(Code::bad_input, "its table does not tell the labels of its columns (values_block_0_kind)");
  if (in.text_attribute(table, "values_block_1_kind"))
    return fail(Code::bad_input, "its table has columns of several kinds; need numbers alone");
  const auto columns = parse_pickled_labels(*pickle);
  if (!columns) return std::unexpected(columns.error());
  const auto kind = in.text_attribute(table, "index_kind");
  if (kind && *kind != "integer")
    return fail(Code::bad_input, fmt::format("its rows are numbered by '{}', as those of single images are; "
                                             "need the numbers of a video's frames",
                                             printable(*kind, 40)));
  const auto index = in.member(table, "index");
  const auto rows = in.member(table, "values_block_0");
  if (!index || !rows) return fail(Code::bad_input, "its table has no numbers in index and values_block_0");
  return arrange_columns(*columns, *index, *rows);
}

/// What `format="fixed"` writes: one block of values, and for each level of the columns its names and which
/// of them each column has.
Result<PoseTable> read_blocks(Input& in, hid_t group) {
  const Handle values = in.object(group, "block0_values"), index = in.object(group, "axis1");
  const auto shape = in.number_shape(values.id());
  const auto rows = in.numbers<double>(values.id()), frames = in.numbers<double>(index.id());
  if (in.number_attribute(group, "nblocks") != 1.0 || !shape || shape->size() != 2 || !rows || !frames)
    return fail(Code::bad_input,
                "its table is not one block of numbers with numbered rows, as of a video; files of single "
                "images are not read");
  // Without rows, a width is what anybody wrote there.
  if (static_cast<std::uint64_t>((*shape)[1]) > rows->size())
    return fail(Code::bad_input, fmt::format("its table of {} x {} numbers holds {}; need one row at least",
                                             (*shape)[0], (*shape)[1], rows->size()));
  Columns columns(static_cast<std::size_t>((*shape)[1]));
  for (int level = 0; level < 4; ++level) {
    const Handle names = in.object(group, fmt::format("block0_items_level{}", level));
    const Handle labels = in.object(group, fmt::format("block0_items_label{}", level));
    if (!names && level == 3) break;
    const auto texts = in.texts(names.id());
    const auto which = in.numbers<double>(labels.id());
    if (!texts || !which || which->size() != columns.size())
      return fail(Code::bad_input, fmt::format("the labels of its columns, level {}, cannot be read", level));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double k = (*which)[c];
      if (!(k >= 0.0 && k < static_cast<double>(texts->size())))
        return fail(Code::bad_input, fmt::format("column {} has no label on level {}", c + 1, level));
      columns[c].push_back((*texts)[static_cast<std::size_t>(k)]);
    }
  }
  return arrange_columns(columns, *frames, *rows);
}

}  // namespace

Result<PoseTable> arrange_columns(const Columns& columns, const Array<double>& frame_numbers,
                                  const Array<double>& rows) {
  PoseTable out{.frames = static_cast<std::int64_t>(frame_numbers.size())};
  if (columns.empty() || frame_numbers.empty() || rows.size() / columns.size() != frame_numbers.size() ||
      rows.size() % columns.size() != 0)
    return fail(Code::bad_input,
                fmt::format("{} labels of columns and {} numbers of frames do not fit {} values",
                            columns.size(), frame_numbers.size(), rows.size()));
  for (std::size_t f = 0; f < frame_numbers.size(); ++f)
    if (frame_numbers[f] != static_cast<double>(f))
      return fail(Code::bad_input, fmt::format("row {} is frame {}; need 0, 1, 2, ... without a gap", f + 1,
                                               frame_numbers[f]));
  struct Target {
    std::size_t person, point, coordinate;
  };
  std::map<std::string, std::size_t> people, points;
  std::vector<Target> targets;
  for (const auto& labels : columns) {
    const auto coordinate =
        labels.size() == 3 || labels.size() == 4 ? coordinate_of(labels.back()) : std::nullopt;
    if (!coordinate)
      return fail(
          Code::bad_input,
          fmt::format("column {} is '{}' with {} labels; need (scorer, bodypart, coord) or (scorer, "
                      "individual, bodypart, coord), where coord is x, y or likelihood",
                      targets.size() + 1, printable(labels.empty() ? "" : labels.back(), 40), labels.size()));
    targets.push_back({place_of(labels.size() == 4 ? labels[1] : "", people, out.people),
                       place_of(labels[labels.size() - 2], points, out.points), *coordinate});
  }
  const std::size_t samples = out.people.size() * out.points.size();
  std::vector<std::uint8_t> known(3 * samples, 0);
  for (auto& t : targets) {
    auto& twice = known[3 * (t.person * out.points.size() + t.point) + t.coordinate];
    if (twice != 0)
      return fail(Code::bad_input,
                  fmt::format("point '{}' has a coordinate twice", printable(out.points[t.point], 40)));
    twice = 1;
  }
  // Points of one individual alone (of an object, say) are not there for others; nobody has x without y.
  for (std::size_t s = 0; s < samples; ++s)
    if (known[3 * s] != known[3 * s + 1])
      return fail(Code::bad_input, fmt::format("point '{}' has x or y alone",
                                               printable(out.points[s % out.points.size()], 40)));
  if (samples * 3 > 16 * columns.size() + 1000)
    return fail(Code::bad_input, fmt::format("{} individuals of {} points, but only {} columns",
                                             out.people.size(), out.points.size(), columns.size()));
  out.values.resize(3 * samples * frame_numbers.size());
  for (std::size_t f = 0; f < frame_numbers.size(); ++f) {
    double* to = out.values.data() + 3 * samples * f;
    for (std::size_t s = 0; s < samples; ++s) {
      to[3 * s] = to[3 * s + 1] = kNaN;
      to[3 * s + 2] = known[3 * s + 2] != 0 ? kNaN : 1.0;
    }
    for (std::size_t c = 0; c < targets.size(); ++c)
      to[3 * (targets[c].person * out.points.size() + targets[c].point) + targets[c].coordinate] =
          rows[f * columns.size() + c];
  }
  return out;
}

Result<PoseTable> read_deeplabcut(Input& in, hid_t group) {
  const Handle table = in.object(group, "table");
  return table ? read_records(in, table.id()) : read_blocks(in, group);
}

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/neural_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/field_reader.h"
#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

using LabelColumns = std::vector<std::pair<std::string, std::vector<std::string>>>;

std::unexpected<Error> bad_table(const std::string& path, const std::string& what) {
  return fail(Code::bad_input, fmt::format("{}: {}", path, what));
}

/// Numbers of a column, one a row.
Result<Array<double>> numbers_of(Input& in, const std::string& path) {
  const Handle column = in.object(in.file(), path);
  const auto shape = in.number_shape(column.id());
  auto out = in.numbers<double>(column.id());
  if (!out || !shape || shape->size() != 1) return bad_table(path, "does not hold a number for each row");
  return std::move(*out);
}

/// LabelColumns of `rows` texts or numbers, one a row: those that say something of it. `except` are read by
/// themselves. Lists, references and images are passed over.
LabelColumns labels_of(Input& in, const std::string& table, std::size_t rows,
                       const std::vector<std::string>& except) {
  LabelColumns out;
  const Handle group = in.object(in.file(), table);
  const auto names = in.text_attributes(group.id(), "colnames");
  if (!names) return out;
  for (const auto& name : *names) {
    if (std::ranges::find(except, name) != except.end() || in.object(group.id(), name + "_index")) continue;
    const Handle column = in.object(group.id(), name);
    if (auto texts = in.texts(column.id())) {
      if (texts->size() == rows) out.emplace_back(name, std::move(*texts));
      continue;
    }
    const auto shape = in.number_shape(column.id());
    if (!shape || shape->size() != 1 || std::cmp_not_equal(shape->front(), rows)) continue;
    const auto numbers = in.numbers<double>(column.id());
    if (!numbers || !in.afford(rows, sizeof(std::string))) continue;
    auto& texts = out.emplace_back(name, std::vector<std::string>{}).second;
    for (const double value : *numbers) texts.push_back(std::isnan(value) ? "" : fmt::format("{}", value));
  }
  return out;
}

std::vector<data::LabelledValue> row_of(const LabelColumns& columns, std::size_t row) {
  std::vector<data::LabelledValue> out;
  for (const auto& [name, texts] : columns) out.push_back({.column = name, .value = texts[row]});
  return out;
}

/// Where the spikes of each unit end among all of them.
Result<std::vector<std::size_t>> spike_ends(Input& in, std::size_t spikes) {
  const std::string path = std::string(kUnitsTable) + "/spike_times_index";
  const auto numbers = numbers_of(in, path);
  if (!numbers) return std::unexpected(numbers.error());
  std::vector<std::size_t> out;
  double last = 0.0;
  for (const double end : *numbers) {
    if (!(end >= last && end <= static_cast<double>(spikes)) || end != std::floor(end))
      return bad_table(
          path, fmt::format("holds {} after {}; expected ends that ascend to {}, the number of spikes", end,
                            last, spikes));
    out.push_back(static_cast<std::size_t>(last = end));
  }
  return out;
}

Status read_units(Input& in, data::Neural& out) {
  const std::string path = kUnitsTable;
  if (!in.object(in.file(), path) || !in.object(in.file(), path + "/spike_times")) return {};
  const auto times = numbers_of(in, path + "/spike_times");
  if (!times) return std::unexpected(times.error());
  const auto ends = spike_ends(in, times->size());
  if (!ends) return std::unexpected(ends.error());
  const auto ids = numbers_of(in, path + "/id");
  if (!ids) return std::unexpected(ids.error());
  if (ids->size() != ends->size())
    return bad_table(path, fmt::format("has {} ids and spikes of {} units", ids->size(), ends->size()));
  const auto columns = labels_of(in, path, ids->size(), {"spike_times", "spike_times_index", "id"});
  if (!in.afford(ids->size(), sizeof(data::SpikeTrain)) || !in.afford(times->size(), sizeof(double)))
    return bad_table(path, "holds more units than the size of the file allows");
  std::size_t first = 0;
  for (std::size_t u = 0; u < ids->size(); ++u) {
    const auto from = times->begin() + static_cast<std::ptrdiff_t>(first),
               to = times->begin() + static_cast<std::ptrdiff_t>((*ends)[u]);
    out.units.push_back(
        {.id = fmt::format("{}", (*ids)[u]), .labels = row_of(columns, u), .times_s = {from, to}});
    first = (*ends)[u];
  }
  return {};
}

Status read_intervals(Input& in, data::Neural& out) {
  const Handle group = in.object(in.file(), kIntervals);
  const auto names = in.children(group.id());
  if (!group || !names) return {};
  for (const auto& name : *names) {
    const std::string path = fmt::format("{}/{}", kIntervals, name);
    const Handle table = in.object(group.id(), name);
    if (name == kUnloaded || in.text_attribute(table.id(), "neurodata_type") != "TimeIntervals") continue;
    if (!in.object(table.id(), "start_time")) continue;
    const auto start = numbers_of(in, path + "/start_time"), stop = numbers_of(in, path + "/stop_time");
    if (!start) return std::unexpected(start.error());
    if (!stop) return std::unexpected(stop.error());
    if (start->size() != stop->size())
      return bad_table(path, fmt::format("has {} starts and {} stops", start->size(), stop->size()));
    const auto columns =
        labels_of(in, path, start->size(), {"start_time", "stop_time", "timeseries", "timeseries_index"});
    if (!in.afford(start->size(), sizeof(data::LabelledInterval)))
      return bad_table(path, "holds more intervals than the size of the file allows");
    auto& made = out.intervals.emplace_back();
    made.name = name;
    for (std::size_t i = 0; i < start->size(); ++i)
      made.rows.push_back({.start_s = (*start)[i], .stop_s = (*stop)[i], .labels = row_of(columns, i)});
  }
  return {};
}

Result<data::Neural> read_parts(Input& in, bool fields) {
  if (in.text_attribute(in.file(), "neurodata_type") != "NWBFile")
    return fail(Code::bad_input,
                "is HDF5 but not an NWB file: it has no neurodata_type NWBFile. Nothing was read.");
  data::Neural out;
  if (auto s = read_units(in, out); !s) return std::unexpected(s.error());
  if (auto s = read_intervals(in, out); !s) return std::unexpected(s.error());
  if (auto s = fields ? read_fields(in, out) : Status(); !s) return std::unexpected(s.error());
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

Result<data::Neural> read_file(const std::filesystem::path& path, bool fields) {
  const Quiet quiet;
  auto in = Input::open(path);
  if (!in) return std::unexpected(in.error());
  auto out = read_parts(*in, fields);
  if (!out) return fail_at(in->name(), out.error());
  const auto written = in->text_attribute(in->file(), kDigestAttribute);
  if (!written || content_digest(*in) == *written) return out;
  return fail_at(in->name(), {.code = Code::bad_input,
                              .message = "its content is not what was written: the digest does not fit; the "
                                         "file is damaged. Nothing was read."});
}

}  // namespace

Result<data::Neural> read_neural_here(const std::filesystem::path& path) { return read_file(path, false); }

Result<data::Neural> read_lanes_here(const std::filesystem::path& path) { return read_file(path, true); }

}  // namespace kinemark::io::internal

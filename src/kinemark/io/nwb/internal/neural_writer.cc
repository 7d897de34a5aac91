// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/neural_writer.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/missing.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

constexpr const char* kGroups = "/general/extracellular_ephys";
constexpr const char* kArray = "array";

/// What rows say of themselves, a column of texts each.
template <class Rows>
void add_labels(const Rows& rows, std::vector<Column>& columns) {
  for (std::size_t k = 0; k < rows.front().labels.size(); ++k) {
    Column column{.name = rows.front().labels[k].column, .description = "as the recording was made"};
    for (const auto& row : rows) column.texts.push_back(row.labels[k].value);
    columns.push_back(std::move(column));
  }
}

void write_units(Output& out, const std::vector<data::SpikeTrain>& units) {
  if (units.empty()) return;
  std::vector<Column> columns;
  add_labels(units, columns);
  Column times{.name = "spike_times", .description = "when the unit fired, s"};
  for (const auto& unit : units) {
    times.numbers.insert(times.numbers.end(), unit.times_s.begin(), unit.times_s.end());
    times.ends.push_back(static_cast<std::int64_t>(times.numbers.size()));
  }
  columns.push_back(std::move(times));
  out.table(out.file(), "units", "spikes of single units", columns, "Units");
}

/// The group `intervals`, which the time without loads on plates may have made.
Handle intervals_group(Output& out) {
  if (H5Lexists(out.file(), "intervals", H5P_DEFAULT) <= 0) return out.group(out.file(), kIntervals);
  return {H5Gopen2(out.file(), "intervals", H5P_DEFAULT), H5Gclose};
}

void write_intervals(Output& out, const std::vector<data::IntervalTable>& tables) {
  for (const auto& table : tables) {
    if (table.rows.empty()) continue;
    Column start{.name = "start_time", .description = "first instant, s"};
    Column stop{.name = "stop_time", .description = "last instant, s"};
    for (const auto& row : table.rows) {
      start.numbers.push_back(row.start_s);
      stop.numbers.push_back(row.stop_s);
    }
    std::vector<Column> columns{std::move(start), std::move(stop)};
    add_labels(table.rows, columns);
    const Handle group = intervals_group(out);
    out.table(group.id(), table.name.c_str(), fmt::format("{} of the session", table.name).c_str(), columns,
              "TimeIntervals");
  }
}

/// A device, its array of electrodes, and a row for each of them.
void write_electrodes(Output& out, std::size_t count) {
  const Handle devices = out.group(out.file(), "/general/devices");
  const Handle device = out.group(devices.id(), kArray, "Device");
  out.attribute(device.id(), "description", "array of electrodes");
  const Handle groups = out.group(out.file(), kGroups);
  const Handle group = out.group(groups.id(), kArray, "ElectrodeGroup");
  out.attribute(group.id(), "description", fmt::format("{} electrodes", count));
  out.attribute(group.id(), "location", "unknown");
  out.soft_link(group.id(), "device", fmt::format("/general/devices/{}", kArray));
  Column location{.name = "location", .description = "where it is in the brain"};
  Column of{.name = "group", .description = "its array"};
  Column name{.name = "group_name", .description = "name of its array"};
  location.texts.assign(count, "unknown");
  of.references.assign(count, fmt::format("{}/{}", kGroups, kArray));
  name.texts.assign(count, kArray);
  out.table(groups.id(), "electrodes", "electrodes of the field potentials", {location, of, name},
            "ElectrodesTable");
}

void write_field(Output& out, hid_t parent, const data::FieldSamples& field, int compression) {
  const auto width = static_cast<int>(field.channels.size());
  const auto rows = static_cast<std::int64_t>(field.values.size() / field.channels.size());
  const Handle series = out.group(parent, field.name.c_str(), "ElectricalSeries");
  out.attribute(series.id(), "description", "field potential");
  out.attribute(series.id(), "comments", "no comments");
  const Handle samples = out.samples(series.id(), "data", H5T_IEEE_F64LE, rows, width, kNaN, compression);
  out.attribute(samples.id(), "unit", "volts");
  out.attribute(samples.id(), "conversion", 1.0, H5T_IEEE_F32LE);
  out.attribute(samples.id(), "offset", 0.0, H5T_IEEE_F32LE);
  out.attribute(samples.id(), "resolution", -1.0, H5T_IEEE_F32LE);
  out.write(samples, H5T_NATIVE_DOUBLE, 0, rows, width, field.values.data());
  const Handle start = out.number(series.id(), "starting_time", field.t0_s);
  out.attribute(start.id(), "rate", field.rate_hz, H5T_IEEE_F64LE);
  out.attribute(start.id(), "unit", "seconds");
  std::vector<std::int64_t> row(field.channels.size());
  for (std::size_t k = 0; k < row.size(); ++k) row[k] = static_cast<std::int64_t>(k);
  const Handle electrodes = out.integers(series.id(), "electrodes", row);
  out.declare(electrodes.id(), "DynamicTableRegion", "hdmf-common");
  out.attribute(electrodes.id(), "description", "electrodes of the channels");
  out.reference(electrodes.id(), "table", kElectrodes);
}

void write_fields(Output& out, const std::vector<data::FieldSamples>& fields, int compression) {
  if (fields.empty()) return;
  std::size_t most = 0;
  for (const auto& field : fields) most = std::max(most, field.channels.size());
  write_electrodes(out, most);
  const Handle module = out.group(out.file(), "/processing/ecephys", "ProcessingModule");
  out.attribute(module.id(), "description", "field potentials");
  const Handle container = out.group(module.id(), "LFP", "LFP");
  for (const auto& field : fields) write_field(out, container.id(), field, compression);
}

}  // namespace

void write_neural(Output& out, const data::Neural& neural, const std::vector<data::FieldSamples>& fields,
                  int compression) {
  write_units(out, neural.units);
  write_intervals(out, neural.intervals);
  write_fields(out, fields, compression);
}

}  // namespace kinemark::io::internal

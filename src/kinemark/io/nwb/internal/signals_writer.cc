// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/signals_writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "kinemark/core/missing.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

constexpr std::int64_t kBlockRows = 16 * 4096;

/// A unit as NWB wants it, in words of the SI, and how much of it a number of the file is.
struct NwbUnit {
  std::string_view in_file;
  const char* words;
  double conversion;
};
constexpr std::array kUnits = {NwbUnit{"V", "volts", 1.0},
                               NwbUnit{"mV", "volts", 1e-3},
                               NwbUnit{"uV", "volts", 1e-6},
                               NwbUnit{"N", "newtons", 1.0},
                               NwbUnit{"Nm", "newton meters", 1.0},
                               NwbUnit{"N m", "newton meters", 1.0},
                               NwbUnit{"Nmm", "newton meters", 1e-3},
                               NwbUnit{"N mm", "newton meters", 1e-3},
                               NwbUnit{"m", "meters", 1.0},
                               NwbUnit{"mm", "meters", 1e-3},
                               NwbUnit{"deg", "degrees", 1.0},
                               NwbUnit{"rad", "radians", 1.0}};

/// What a series of `width` numbers a sample is, but for its samples.
struct Shape {
  const char* type = "TimeSeries";
  std::string description;
  std::string unit;  ///< as the file says
  std::int64_t rows = 0;
  int width = 1;
  double t0_s = 0.0;
  double rate_hz = 1.0;
};

void write_unit(Output& out, hid_t samples, const std::string& unit) {
  const auto known = std::ranges::find(kUnits, unit, &NwbUnit::in_file);
  const bool found = known != kUnits.end();
  out.attribute(samples, "unit", found ? known->words : unit.empty() ? "n.a." : unit.c_str());
  out.attribute(samples, "conversion", found ? known->conversion : 1.0, H5T_IEEE_F32LE);
  out.attribute(samples, "offset", 0.0, H5T_IEEE_F32LE);
  out.attribute(samples, "resolution", -1.0, H5T_IEEE_F32LE);
}

/// A series without its samples, and the dataset that they go to.
Handle make_series(Output& out, hid_t parent, const std::string& name, const Shape& shape, hid_t file_type,
                   double fill, int compression) {
  const Handle series = out.group(parent, name.c_str(), shape.type);
  out.attribute(series.id(), "description", shape.description);
  out.attribute(series.id(), "comments", "no comments");
  Handle samples = out.samples(series.id(), "data", file_type, shape.rows, shape.width, fill, compression);
  write_unit(out, samples.id(), shape.unit);
  const Handle start = out.number(series.id(), "starting_time", shape.t0_s);
  out.attribute(start.id(), "rate", shape.rate_hz, H5T_IEEE_F64LE);
  out.attribute(start.id(), "unit", "seconds");
  return samples;
}

/// Numbers of `columns` of an array of `across` groups of `width` each, row by row, in blocks.
template <class T>
void put_columns(Output& out, const Handle& samples, hid_t memory_type, const T* values, std::int64_t rows,
                 std::size_t across, std::size_t width, const std::vector<std::size_t>& columns) {
  std::vector<T> block;
  for (std::int64_t first = 0; first < rows; first += kBlockRows) {
    const std::int64_t n = std::min(kBlockRows, rows - first);
    block.clear();
    for (std::int64_t r = first; r < first + n; ++r)
      for (const std::size_t column : columns) {
        const T* from = values + (static_cast<std::size_t>(r) * across + column) * width;
        block.insert(block.end(), from, from + width);
      }
    out.write(samples, memory_type, first, n, static_cast<int>(width * columns.size()), block.data());
  }
}

/// One series of every marker in a container, of an array frames x markers.
template <class T>
void write_of_markers(Output& out, hid_t module, const char* container, const Shape& shape, hid_t file_type,
                      hid_t memory_type, const Array<T>& values, const data::Trial& trial,
                      const std::vector<std::string>& series_of_marker, double fill, int compression) {
  if (values.empty()) return;
  const Handle group = out.group(module, container, "BehavioralTimeSeries");
  const auto& markers = trial.markers;
  for (std::size_t m = 0; m < series_of_marker.size(); ++m) {
    Shape one = shape;
    one.description = fmt::format("{} of marker {}", shape.description, markers.names[m]);
    const Handle samples =
        make_series(out, group.id(), series_of_marker[m], one, file_type, fill, compression);
    put_columns(out, samples, memory_type, values.data(), one.rows, series_of_marker.size(), 1, {m});
  }
}

void write_reconstruction(Output& out, hid_t module, const data::Trial& trial,
                          const std::vector<std::string>& series_of_marker, int compression) {
  const TimeBase& time = trial.markers.time;
  Shape shape{.description = "residual of the reconstruction",
              .unit = "m",
              .rows = time.frames,
              .t0_s = time.t0_s,
              .rate_hz = time.rate_hz};
  write_of_markers(out, module, kResidual, shape, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, trial.residual_m, trial,
                   series_of_marker, kNaN, compression);
  shape.description = "cameras that saw a sample (bit c: camera c + 1)";
  shape.unit.clear();
  write_of_markers(out, module, kCameras, shape, H5T_STD_U8LE, H5T_NATIVE_UINT8, trial.camera_mask, trial,
                   series_of_marker, 0.0, compression);
}

void write_channels(Output& out, hid_t module, const data::Trial& trial, int compression) {
  const data::Channels& c = trial.channels;
  if (c.count() == 0) return;
  const Handle group = out.group(module, kChannels, "BehavioralTimeSeries");
  const std::vector<std::string> series = series_names(c.names);
  Column kinds{.name = "kind", .description = "what it tells"};
  for (std::size_t k = 0; k < c.names.size(); ++k) {
    const Shape shape{.description = fmt::format("{} {} (x, y, z)", data::to_string(c.kinds[k]), c.names[k]),
                      .unit = c.units[k],
                      .rows = c.frames,
                      .width = 3,
                      .t0_s = trial.markers.time.t0_s,
                      .rate_hz = c.rate_hz};
    const Handle samples = make_series(out, group.id(), series[k], shape, H5T_IEEE_F64LE, kNaN, compression);
    put_columns(out, samples, H5T_NATIVE_DOUBLE, c.values.data(), c.frames, c.names.size(), 3, {k});
    kinds.texts.emplace_back(data::to_string(c.kinds[k]));
  }
  out.table(
      module, kChannelsTable, "points of the file that are no markers, in their order",
      {{.name = "channel", .description = "its name", .texts = c.names},
       {.name = "series", .description = "name of its series in Channels", .texts = series},
       kinds,
       {.name = "unit", .description = "its unit, as the file says; empty: not stated", .texts = c.units},
       {.name = "rate_hz",
        .description = "samples per second",
        .numbers = std::vector<double>(c.names.size(), c.rate_hz)}});
}

/// Analog channels of one unit, which share a series.
struct OneUnit {
  std::string unit;
  std::vector<std::size_t> channels;
};

std::vector<OneUnit> by_unit(const data::AnalogChannels& a) {
  std::vector<OneUnit> out;
  for (std::size_t k = 0; k < a.names.size(); ++k) {
    const std::string unit = a.units.empty() ? "" : a.units[k];
    auto at = std::ranges::find(out, unit, &OneUnit::unit);
    if (at == out.end()) at = out.insert(out.end(), {.unit = unit, .channels = {}});
    at->channels.push_back(k);
  }
  return out;
}

std::vector<std::string> analog_series_names(const std::vector<OneUnit>& units) {
  std::vector<std::string> out;
  for (const OneUnit& one : units) out.push_back(one.unit.empty() ? "analog" : "analog_" + one.unit);
  return series_names(out);
}

void write_analog_series(Output& out, const data::Trial& trial, const std::string& name, const OneUnit& one,
                         int compression) {
  const data::AnalogChannels& a = trial.analog;
  const Handle acquisition(H5Gopen2(out.file(), kAcquisition, H5P_DEFAULT), H5Gclose);
  Shape shape{.description = "analog channels, a column each:",
              .unit = one.unit,
              .rows = a.samples,
              .width = static_cast<int>(one.channels.size()),
              .t0_s = trial.markers.time.t0_s,
              .rate_hz = a.rate_hz};
  for (const std::size_t k : one.channels) shape.description += " " + a.names[k];
  const Handle samples = make_series(out, acquisition.id(), name, shape, H5T_IEEE_F64LE, kNaN, compression);
  put_columns(out, samples, H5T_NATIVE_DOUBLE, a.values.data(), a.samples, a.names.size(), 1, one.channels);
}

void write_analog(Output& out, hid_t module, const data::Trial& trial, int compression) {
  const data::AnalogChannels& a = trial.analog;
  if (a.names.empty()) return;
  Column series{.name = "series", .description = "name of its series in /acquisition; empty: no samples"};
  Column column{.name = "column", .description = "its column there, from 0"};
  series.texts.resize(a.names.size());
  column.integers.resize(a.names.size());
  const std::vector<OneUnit> units = by_unit(a);
  const std::vector<std::string> names = analog_series_names(units);
  for (std::size_t u = 0; u < units.size() && a.samples > 0; ++u) {
    write_analog_series(out, trial, names[u], units[u], compression);
    for (std::size_t i = 0; i < units[u].channels.size(); ++i) {
      series.texts[units[u].channels[i]] = names[u];
      column.integers[units[u].channels[i]] = static_cast<std::int64_t>(i);
    }
  }
  std::vector<Column> columns{
      {.name = "channel", .description = "its name", .texts = a.names}, series, column};
  columns.push_back({.name = "rate_hz",
                     .description = "samples per second",
                     .numbers = std::vector<double>(a.names.size(), a.rate_hz)});
  if (!a.units.empty())
    columns.push_back(
        {.name = "unit", .description = "its unit, as the file says; empty: not stated", .texts = a.units});
  out.table(module, kAnalogTable, "analog channels, in their order", columns);
}

void write_events(Output& out, hid_t module, const std::vector<data::Event>& events) {
  if (events.empty()) return;
  Column time{.name = "timestamp", .description = "when it is, s"};
  Column label{.name = "label", .description = "what it is, as Foot Strike"};
  Column context{.name = "context", .description = "of which side: Left, Right, General or empty"};
  for (const data::Event& event : events) {
    time.numbers.push_back(event.time_s);
    label.texts.push_back(event.label);
    context.texts.push_back(event.context);
  }
  out.table(module, kEventsTable, "events, in the order of the file", {time, label, context});
}

/// Lists of different lengths as rows of one length: what a row lacks is `filler`.
template <class To, class List>
void add_ragged(const std::vector<data::ForcePlate>& plates, List data::ForcePlate::* list, To filler,
                std::vector<To>& out, Column& column) {
  std::size_t longest = 0;
  for (const auto& plate : plates) longest = std::max(longest, (plate.*list).size());
  column.across = {longest};
  for (const auto& plate : plates) {
    for (const auto value : plate.*list) out.push_back(static_cast<To>(value));
    out.resize(out.size() + longest - (plate.*list).size(), filler);
  }
}

/// Which channels of the recording, and what turns them into forces.
void add_wiring(const std::vector<data::ForcePlate>& plates, std::vector<Column>& columns) {
  Column channels{.name = "channels", .description = "rows of analog_channels, from 0; -1: it has no more"};
  add_ragged(plates, &data::ForcePlate::channel_idx, std::int64_t{-1}, channels.integers, channels);
  Column values{.name = "calibration",
                .description = "calibration matrix, column by column; NaN behind its end"};
  add_ragged(plates, &data::ForcePlate::calibration, kNaN, values.numbers, values);
  Column count{.name = "calibration_values", .description = "how many numbers of calibration are its own"};
  Column rows{.name = "calibration_rows", .description = "rows of the calibration matrix; 0 without"};
  for (const auto& plate : plates) {
    count.integers.push_back(static_cast<std::int64_t>(plate.calibration.size()));
    rows.integers.push_back(plate.calibration_rows);
  }
  if (!channels.integers.empty()) columns.push_back(std::move(channels));
  if (!values.numbers.empty()) columns.push_back(std::move(values));
  columns.push_back(std::move(count));
  columns.push_back(std::move(rows));
  Column polynomials{.name = "pressure_correction",
                     .description =
                         "polynomials of the error of the centre of pressure, 2 x 6 column by "
                         "column, mm; NaN: none"};
  add_ragged(plates, &data::ForcePlate::pressure_correction, kNaN, polynomials.numbers, polynomials);
  if (!polynomials.numbers.empty()) columns.push_back(std::move(polynomials));
}

void write_plates(Output& out, hid_t module, const std::vector<data::ForcePlate>& plates) {
  if (plates.empty()) return;
  Column number{.name = "number", .description = "as the file counts, from 1"};
  Column type{.name = "type", .description = "type of the plate as C3D files count them, 1 to 7"};
  Column corners{
      .name = "corners", .description = "its four corners in the frame of the markers, m", .across = {4, 3}};
  Column origin{.name = "origin", .description = "origin of its channels in the plate, m", .across = {3}};
  Column metres{.name = "metres_per_unit", .description = "of lengths in channels that state no unit, m"};
  for (const data::ForcePlate& plate : plates) {
    number.integers.push_back(plate.number);
    type.integers.push_back(plate.type);
    for (const auto& corner : plate.corners_in_world)
      corners.numbers.insert(corners.numbers.end(), corner.begin(), corner.end());
    origin.numbers.insert(origin.numbers.end(), plate.origin_in_plate.begin(), plate.origin_in_plate.end());
    metres.numbers.push_back(plate.metres_per_unit);
  }
  std::vector<Column> columns{number, type, corners, origin, metres};
  add_wiring(plates, columns);
  out.table(module, kPlatesTable, "force plates, in the order of the file", columns);
}

void write_unloaded(Output& out, const std::array<double, 2>& unloaded_s) {
  if (!(unloaded_s[0] <= unloaded_s[1])) return;
  const Handle intervals = out.group(out.file(), kIntervals);
  out.table(intervals.id(), kUnloaded, "when nobody loads the force plates",
            {{.name = "start_time", .description = "its first frame, s", .numbers = {unloaded_s[0]}},
             {.name = "stop_time", .description = "its last frame, s", .numbers = {unloaded_s[1]}}},
            "TimeIntervals");
}

void write_calibration(Output& out, hid_t module, const data::CalibrationError& error) {
  if (!error.known()) return;
  out.table(
      module, kCalibrationTable, "what the calibration of the cameras leaves unknown of all positions",
      {{.name = "error",
        .description = "displacement fields of the room, standard normal factors: middle, rotation, scale, "
                       "polynomials of degree 3",
        .texts = {data::to_text(error)}}});
}

}  // namespace

void write_signals(Output& out, hid_t module, const data::Trial& trial,
                   const std::vector<std::string>& series_of_marker, int compression) {
  write_reconstruction(out, module, trial, series_of_marker, compression);
  write_channels(out, module, trial, compression);
  write_analog(out, module, trial, compression);
  write_events(out, module, trial.events);
  write_plates(out, module, trial.force_plates);
  write_unloaded(out, trial.unloaded_s);
  write_calibration(out, module, trial.calibration_error);
}

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/external_forces.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "kinemark/data/resample_forces.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/markers/marker_format.h"
#include "kinemark/io/osim/external_loads.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/io/text/d_flow_forces.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::io {
namespace {

Result<ExternalForces> read_plates(const std::filesystem::path& path, const TimeBase& time,
                                   double contact_force_n) {
  const auto trial = read_markers(path);
  if (!trial) return std::unexpected(trial.error());
  auto plates = plate_forces(*trial, {.contact_force_n = contact_force_n});
  if (!plates) return std::unexpected(plates.error());
  ExternalForces out{.wrenches = data::resample(plates->wrenches, time),
                     .files = {path},
                     .warnings = {},
                     .contradicted = std::move(plates->contradicted)};
  // Of its other irregularities, those of its markers, nothing is used here.
  std::ranges::copy_if(trial->warnings, std::back_inserter(out.warnings),
                       [](const std::string& warning) { return warning.starts_with("force plate "); });
  std::ranges::move(plates->warnings, std::back_inserter(out.warnings));
  return out;
}

/// Whether files of an extension can hold force plates.
bool keeps_plates(std::string_view extension) {
  const auto* format = written_format(extension);
  return format != nullptr && format->keeps(Part::force_plates) != Kept::none;
}

Result<ExternalForces> read_loads(const std::filesystem::path& path, const TimeBase& time) {
  const auto loads = read_external_loads(path);
  if (!loads) return std::unexpected(loads.error());
  const auto table = read_table(loads->data_file);
  if (!table)
    return fail(table.error().code,
                fmt::format("{} (the <datafile> of {})", table.error().message, path.string()));
  auto wrenches = sample_external_loads(*loads, *table, time);
  if (!wrenches) return std::unexpected(wrenches.error());
  return ExternalForces{.wrenches = std::move(*wrenches),
                        .files = {path, loads->data_file},
                        .warnings = table->warnings,
                        .contradicted = {}};
}

Result<ExternalForces> read_columns(const std::filesystem::path& path, const TimeBase& time) {
  const auto table = read_table(path);
  if (!table) return std::unexpected(table.error());
  const auto loads = loads_of_columns(*table, path);
  if (!loads) return std::unexpected(loads.error());
  auto wrenches = sample_external_loads(*loads, *table, time);
  if (!wrenches) return std::unexpected(wrenches.error());
  return ExternalForces{
      .wrenches = std::move(*wrenches), .files = {path}, .warnings = table->warnings, .contradicted = {}};
}

Result<ExternalForces> of_d_flow(const std::filesystem::path& path, data::Table table, const TimeBase& time) {
  const auto loads = loads_of_columns(table, path);
  if (!loads) return std::unexpected(loads.error());
  auto wrenches = sample_external_loads(*loads, table, time);
  if (!wrenches) return std::unexpected(wrenches.error());
  return ExternalForces{.wrenches = std::move(*wrenches),
                        .files = {path},
                        .warnings = std::move(table.warnings),
                        .contradicted = {}};
}

}  // namespace

Result<ExternalForces> read_own_forces(const std::filesystem::path& path, const TimeBase& time,
                                       double contact_force_n) {
  auto table = read_d_flow_forces(path, contact_force_n);
  if (!table) return std::unexpected(table.error());
  // Rows are the frames of the markers, whose times may be uneven by a little.
  if (table->rows() == time.frames)
    for (std::int64_t f = 0; f < time.frames; ++f)
      table->time_s[static_cast<std::size_t>(f)] = time.time_s(f);
  return of_d_flow(path, std::move(*table), time);
}

Result<ExternalForces> read_external_forces(const std::filesystem::path& path, const TimeBase& time,
                                            double contact_force_n) {
  std::string kind = path.extension().string();
  std::ranges::transform(kind, kind.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (kind == ".xml") return read_loads(path, time);
  if (kind == ".mot" || kind == ".sto") return read_columns(path, time);
  if (kind == ".txt") {
    auto table = read_d_flow_forces(path, contact_force_n);
    return table ? of_d_flow(path, std::move(*table), time)
                 : Result<ExternalForces>(std::unexpected(table.error()));
  }
  if (keeps_plates(kind)) return read_plates(path, time, contact_force_n);
  return fail(
      Code::usage,
      fmt::format(
          "{}: forces are read from the plates of a .c3d or .mat file, from a .mot or .sto with "
          "columns such as ground_force_vx, from a .txt of D-Flow, or from an OpenSim ExternalLoads .xml",
          path.string()));
}

}  // namespace kinemark::io

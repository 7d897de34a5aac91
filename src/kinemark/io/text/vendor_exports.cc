// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/vendor_exports.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/marker_rows.h"
#include "kinemark/io/text/internal/vendor_headers.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::Lines;
using internal::VendorHeader;

std::string_view format_name(VendorExport which) {
  switch (which) {
    case VendorExport::qtm:
      return "QTM TSV";
    case VendorExport::motive:
      return "Motive CSV";
    case VendorExport::vicon:
      return "Vicon CSV";
    case VendorExport::phasespace:
      return "PhaseSpace CSV";
    case VendorExport::coordinates:
      return "table of coordinates";
  }
  return "";
}

Result<VendorHeader> parse_header(Lines& lines, VendorExport which, std::string_view unit, double rate_hz,
                                  data::Trial& trial) {
  switch (which) {
    case VendorExport::qtm:
      return internal::parse_qtm_header(lines, trial);
    case VendorExport::motive:
      return internal::parse_motive_header(lines, trial);
    case VendorExport::vicon:
      return internal::parse_vicon_header(lines, trial);
    case VendorExport::phasespace:
      return internal::parse_phasespace_header(lines, trial);
    case VendorExport::coordinates:
      return internal::parse_coordinates_header(lines, trial, unit, rate_hz);
  }
  return fail(Code::usage, "no such text");
}

/// What follows the rows of trajectories.
void note_rest(Lines& lines, VendorExport which, data::Trial& trial) {
  if (const std::int64_t line = lines.skip_blank(); line > 0)
    trial.warnings.push_back(fmt::format("a blank line ends the {}; line {} and what follows is not read",
                                         which == VendorExport::vicon ? "trajectories" : "data", line));
}

/// Coordinates are as the file has them: of m, cm and mm the one that makes the recording as large as a body.
Status settle_unit_by_size(data::Trial& trial) {
  const double extent = internal::largest_extent(trial.markers);
  static const std::array<LengthUnitName, 3> kUnits{{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}}};
  const auto unit = unit_of_body_size(kUnits, extent);
  if (!unit)
    return fail(
        Code::bad_input,
        fmt::format(
            "states no unit of length, and its coordinates, which reach over {:.4g}, may be of several; give "
            "it with --unit mm, cm or m, or in the labels: 'A_X (mm)'",
            extent));
  for (double& coordinate : trial.markers.x_in_world) coordinate /= 1.0 / unit->metres;
  trial.units_in_file = unit->name;
  trial.warnings.push_back(
      fmt::format("no unit of length is stated; taken for {}, as the markers reach over {:.3g} m then",
                  unit->name, extent * unit->metres));
  return {};
}

/// Markers behind the real ones become channels, in the file's own numbers.
Status move_outputs(const VendorHeader& header, data::Trial& trial) {
  const auto outputs = std::ssize(header.outputs);
  if (outputs == 0) return {};
  data::Trajectories all = std::exchange(trial.markers, {});
  const auto bodies = all.markers() - outputs, frames = all.frames();
  const auto first = all.names.begin() + bodies;
  trial.markers = data::Trajectories::all_missing({all.names.begin(), first}, all.time);
  auto& channels = trial.channels;
  channels.names.assign(first, all.names.end());
  channels.rate_hz = all.time.rate_hz;
  channels.frames = frames;
  channels.values.assign(static_cast<std::size_t>(3 * frames * outputs), kNaN);
  for (const auto& output : header.outputs) {
    channels.kinds.push_back(output.kind);
    channels.units.push_back(output.unit);
  }
  for (std::int64_t f = 0; f < frames; ++f) {
    for (std::int64_t b = 0; b < bodies; ++b) {
      if (!all.present(f, b)) continue;
      trial.markers.x(f, b) = all.x(f, b);
      trial.markers.state[trial.markers.index(f, b)] = all.state[all.index(f, b)];
    }
    for (std::int64_t k = 0; k < outputs; ++k) {
      if (!all.present(f, header.outputs[static_cast<std::size_t>(k)].body) || !all.present(f, bodies + k))
        continue;
      const Eigen::Vector3d value = all.x(f, bodies + k) * header.columns.units_per_metre;
      std::copy_n(value.data(), 3, channels.values.begin() + 3 * (f * outputs + k));
    }
  }
  trial.warnings.push_back(
      fmt::format("positions are the origins of {} rigid bod{}, which the recorder "
                  "computed from several markers; angles and axes are channels",
                  bodies, bodies == 1 ? "y" : "ies"));
  return trial.validate();
}

Result<data::Trial> parse(std::string_view text, VendorExport which, std::string_view unit, double rate_hz) {
  Lines lines(text);
  data::Trial trial;
  trial.format = format_name(which);
  const auto header = parse_header(lines, which, unit, rate_hz, trial);
  if (!header) return std::unexpected(header.error());
  if (auto s = internal::read_marker_rows(lines, header->columns, text.size(), trial); !s)
    return std::unexpected(s.error());
  note_rest(lines, which, trial);
  if (auto s = move_outputs(*header, trial); !s) return std::unexpected(s.error());
  if (header->is_unit_open) {
    if (auto s = settle_unit_by_size(trial); !s) return std::unexpected(s.error());
    internal::take_zeros_as_missing(trial, 0);
  }
  for (std::int64_t m = 0; m < std::ssize(header->state); ++m) {
    if (header->state[static_cast<std::size_t>(m)] == data::SampleState::measured) continue;
    for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
      if (trial.markers.present(f, m))
        trial.markers.state[trial.markers.index(f, m)] = header->state[static_cast<std::size_t>(m)];
  }
  return trial;
}

/// A row of numbers: a time, then four cells a marker, of which the first, the condition, is a whole number.
/// The row may go on beyond what is there.
bool begins_phasespace(std::string_view begin) {
  const std::size_t end = begin.find_first_of("\r\n");
  const bool whole = end != std::string_view::npos;
  std::string_view row = begin.substr(0, end);
  std::size_t cells = 0;
  while (true) {
    const std::size_t comma = row.find(',');
    if (comma == std::string_view::npos && !whole) break;  // may be cut
    const auto number = parse_number(row.substr(0, comma));
    if (!number) return false;
    if (cells % 4 == 1 && *number != std::floor(*number)) return false;
    ++cells;
    if (comma == std::string_view::npos) break;
    row.remove_prefix(comma + 1);
  }
  return cells >= 5 && (!whole || cells % 4 == 1);
}

}  // namespace

std::optional<VendorExport> vendor_export_of(std::string_view begin) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (begin.starts_with(kByteOrderMark)) begin.remove_prefix(kByteOrderMark.size());
  for (const std::string_view key : {"NO_OF_FRAMES\t", "FILE_VERSION\t", "NO_OF_CAMERAS\t", "MARKER_NAMES\t"})
    if (begin.starts_with(key)) return VendorExport::qtm;
  if (begin.starts_with("Format Version,")) return VendorExport::motive;
  const auto first = internal::lower(begin.substr(0, begin.find_first_of(",\r\n")));
  constexpr std::array<std::string_view, 7> kVicon{"trajectories", "devices", "model outputs", "joints",
                                                   "segments",     "events",  "title"};
  if (std::ranges::find(kVicon, first) != kVicon.end()) return VendorExport::vicon;
  if (begins_phasespace(begin)) return VendorExport::phasespace;
  if (internal::begins_coordinates(begin)) return VendorExport::coordinates;
  return std::nullopt;
}

bool begins_d_flow(std::string_view begin) {
  return vendor_export_of(begin) == VendorExport::coordinates && internal::begins_d_flow(begin);
}

bool lacks_times(std::string_view begin) {
  return vendor_export_of(begin) == VendorExport::coordinates &&
         internal::begins_coordinates_without_times(begin);
}

Result<data::Trial> parse_vendor_export(std::string_view text, std::string_view name, VendorExport which,
                                        std::string_view unit, double rate_hz) {
  auto trial = parse(text, which, unit, rate_hz);
  if (!trial) return fail_at(name, trial.error());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_vendor_export(const std::filesystem::path& path, VendorExport which,
                                       std::string_view unit, double rate_hz) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_vendor_export(*text, path.string(), which, unit, rate_hz);
}

}  // namespace kinemark::io

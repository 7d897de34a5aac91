// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <string>

#include "kinemark/core/check.h"
#include "kinemark/io/file.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/text/trc.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kFlushBytes = 1 << 20;

/// Lines 1 to 6, the blank one included.
std::string header_text(const std::filesystem::path& path, const data::Trial& trial,
                        const TrcWriteOptions& options) {
  const data::Trajectories& markers = trial.markers;
  std::string out = fmt::format(
      "PathFileType\t4\t(X/Y/Z)\t{}{}\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
      "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n"
      "Frame#\tTime",
      path.filename().string(), options.set.empty() ? "" : "\t" + sealed_mark(options.set),
      markers.time.rate_hz, markers.time.rate_hz, markers.frames(), markers.markers(),
      options.units == LengthUnit::metre ? "m" : "mm", markers.time.rate_hz, trial.first_frame,
      markers.frames());
  // Three cells per name; the last two tabs of the last one would be trailing.
  for (std::size_t m = 0; m < markers.names.size(); ++m) out += (m == 0 ? "\t" : "\t\t\t") + markers.names[m];
  out += "\t\t\n\t";
  for (std::size_t m = 1; m <= markers.names.size(); ++m) out += fmt::format("\tX{}\tY{}\tZ{}", m, m, m);
  return out + "\n\n";
}

}  // namespace

Status write_trc(const std::filesystem::path& path, const data::Trial& trial,
                 const TrcWriteOptions& options) {
  check(options.decimals >= -1 && options.decimals <= 17, "TrcWriteOptions::decimals lies outside -1 to 17");
  if (auto status = trial.validate(); !status) return fail_at(path.string(), status.error());
  const data::Trajectories& markers = trial.markers;
  if (markers.frames() == 0 || markers.markers() == 0)
    return fail(Code::bad_input,
                fmt::format("{}: a TRC file needs a frame and a marker; the trial has {} and {}",
                            path.string(), markers.frames(), markers.markers()));
  for (const std::string& name : markers.names)
    if (name.find_first_of("\t\r\n") != std::string::npos)
      return fail(
          Code::bad_input,
          fmt::format("{}: a marker name holds a tab or a line end, which a TRC file cannot", path.string()));

  auto file = OutputFile::create(path, options.force);
  if (!file) return std::unexpected(file.error());
  const auto header = header_text(path, trial, options);
  if (auto status = options.set.empty() ? file->write(header) : file->write_sealed(header); !status)
    return status;
  const double scale = options.units == LengthUnit::metre ? 1.0 : 1000.0;
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    fmt::format_to(end, "{}\t{}", trial.first_frame + f, markers.time.time_s(f));
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      // NaN, not blanks: readers that take runs of tabs for one separator lose count of blank cells.
      if (!markers.present(f, m)) {
        out.append(std::string_view("\tNaN\tNaN\tNaN"));
        continue;
      }
      for (const double value : markers.x(f, m)) {
        if (options.decimals < 0)
          fmt::format_to(end, "\t{}", value * scale);
        else
          fmt::format_to(end, "\t{:.{}f}", value * scale, options.decimals);
      }
    }
    out.push_back('\n');
    if (out.size() < kFlushBytes && f + 1 < markers.frames()) continue;
    if (auto status = file->write(std::string_view(out.data(), out.size())); !status) return status;
    out.clear();
  }
  return file->commit();
}

}  // namespace kinemark::io

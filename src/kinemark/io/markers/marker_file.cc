// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/marker_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/plausible.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/text/trajectories_csv.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/io/text/v3d.h"
#include "kinemark/io/text/vendor_exports.h"

namespace kinemark::io {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string out = path.extension().string();
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

/// Name of the format in messages, by extension.
std::string named(const std::string& extension) {
  return extension.empty() ? "a file without an extension" : "a " + extension + " file";
}

/// The format of a file that begins like this, as an extension, or empty.
std::string_view format_of(std::string_view begin) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (begin.starts_with(kByteOrderMark)) begin.remove_prefix(kByteOrderMark.size());
  if (begin.starts_with("PathFileType")) return ".trc";
  if (begin.starts_with("\x89HDF\r\n\x1a\n")) return ".nwb";
  // The header block of a C3D is never without zero bytes; a text may well have a 'P' (0x50) in second place.
  if (begin.size() > 1 && begin[1] == '\x50' && begin.find('\0') != std::string_view::npos) return ".c3d";
  return "";
}

/// The part of an NWB file that a trial holds.
Result<data::Trial> read_nwb_trial(const std::filesystem::path& path) {
  auto file = read_nwb(path);
  if (!file) return std::unexpected(file.error());
  data::Trial trial{.source = path.string(), .format = "NWB", .units_in_file = "m"};
  trial.software = file->metadata.software;
  trial.markers = std::move(file->trajectories);
  trial.warnings = std::move(file->warnings);
  const double first = trial.markers.time.t0_s * trial.markers.time.rate_hz;
  if (first > 0.0 && first < 1e15) trial.first_frame = std::llround(first) + 1;
  return trial;
}

}  // namespace

bool needs_rate(const std::filesystem::path& path) { return lower_extension(path) == ".v3d"; }

namespace {

/// As the reader of its format reads it; `box_m` around its samples where that reader knows it.
Result<data::Trial> read_as_it_is(const std::filesystem::path& path, const MarkerReadOptions& options,
                                  Eigen::AlignedBox3d& box_m) {
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  std::array<char, 512> begin{};
  const auto size = file->read_at(0, std::as_writable_bytes(std::span(begin)));
  if (!size) return std::unexpected(size.error());
  const auto vendor = vendor_export_of({begin.data(), *size});
  std::string format(format_of({begin.data(), *size}));
  const std::string extension = lower_extension(path);
  if (format.empty()) format = extension;
  if (format == ".v3d") {
    auto text = read_v3d(path, {.rate_hz = options.rate_hz});
    if (!text) return std::unexpected(text.error());
    return std::move(text->trial);
  }
  if (options.rate_hz != 0.0)
    return fail(Code::usage,
                fmt::format("{}: the file stores its own rate; a rate is given only for Visual3D text (.v3d)",
                            path.string()));
  if (vendor) return read_vendor_export(path, *vendor);
  if (format == ".c3d") {
    C3dSeen seen;
    auto trial = read_c3d(path, {}, &seen);
    box_m = seen.box_m;
    return trial;
  }
  if (format == ".trc") return read_trc(path);
  if (format == ".nwb") return read_nwb_trial(path);
  if (format == ".csv") return read_trajectories_csv(path);
  return fail(
      Code::not_supported,
      fmt::format("{}: {} is not read as a marker file; supported are C3D (.c3d), TRC (.trc), NWB (.nwb), "
                  "CSV (.csv), Visual3D text (.v3d), and text exports of QTM (.tsv), Motive and Vicon (.csv)",
                  path.string(), named(extension)));
}

}  // namespace

Result<data::Trial> read_markers(const std::filesystem::path& path, const MarkerReadOptions& options) {
  Eigen::AlignedBox3d box_m;
  auto trial = read_as_it_is(path, options, box_m);
  if (trial) reject_implausible(*trial, box_m);
  return trial;
}

Status check_marker_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const std::string_view known : {".c3d", ".trc", ".nwb", ".csv"})
    if (extension == known) return {};
  return fail(Code::usage,
              fmt::format("{}: {} is not written as a marker file; supported are .c3d, .trc, .nwb and .csv",
                          path.string(), named(extension)));
}

Status write_markers(const std::filesystem::path& path, const data::Trial& trial, bool force,
                     const std::string& set, std::vector<std::string>* lost) {
  if (auto s = check_marker_format(path); !s) return s;
  const std::string extension = lower_extension(path);
  if (extension == ".c3d") return write_c3d(path, trial, {.force = force, .set = set, .lost = lost});
  if (extension == ".trc") return write_trc(path, trial, {.force = force, .set = set});
  if (extension == ".csv") return write_trajectories_csv(path, trial, force);
  NwbMetadata metadata;
  metadata.set = set;
  if (!trial.source.empty()) metadata.sources.push_back({.file = trial.source});
  return write_nwb(path, trial.markers, nullptr, metadata, {.force = force});
}

}  // namespace kinemark::io

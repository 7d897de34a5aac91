// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/marker_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/keypoints/keypoints_file.h"
#include "kinemark/io/markers/foreign_text.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/markers/marker_format.h"
#include "kinemark/io/markers/plausible.h"
#include "kinemark/io/text_dialect.h"

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

/// The format of a file: as its content says, else as its extension does. A text export is known by its
/// content alone; null: none of ours.
const MarkerFormat* format_of(std::string_view begin, const std::string& extension) {
  const auto formats = marker_formats();
  auto found = std::ranges::find_if(
      formats, [&](const MarkerFormat& f) { return f.begins != nullptr && f.begins(begin); });
  if (found == formats.end())
    found = std::ranges::find_if(formats, [&](const MarkerFormat& f) {
      return f.extension == extension && (f.begins == nullptr || f.write != nullptr);
    });
  return found == formats.end() || found->read == nullptr ? nullptr : &*found;
}

bool is_read(const std::string& extension) {
  const auto known = read_extensions();
  return std::ranges::find(known, extension) != known.end();
}

std::string names_without_rate() {
  std::vector<std::string> names;
  for (const MarkerFormat& f : marker_formats())
    if (!f.stores_rate) names.push_back(fmt::format("{} ({})", f.name, f.extension));
  return join_names(names, names.size());
}

std::string names_of_read_formats() {
  std::vector<std::string> names;
  for (const MarkerFormat& f : marker_formats())
    if (f.read != nullptr) names.push_back(fmt::format("{} ({})", f.name, f.extension));
  return join_names(names, names.size());
}

/// The beginning of a file, that of a text in the form that readers expect.
Result<std::string> read_plain_begin(const std::filesystem::path& path) {
  auto begin = read_begin(path);
  if (begin && (begin->find('\0') == std::string::npos || is_utf16(*begin)))
    *begin = in_plain_dialect(std::move(*begin));
  return begin;
}

bool is_text(std::string_view begin) { return begin.find('\0') == std::string_view::npos; }

/// What a text is that no reader knows, and what would bring it in; empty: it is no text. Nothing of it is
/// quoted: a page of `serve` shows this, and the file may be anybody's.
std::string describe_text(std::string_view begin) {
  if (const auto foreign = foreign_text(begin); !foreign.empty()) return ": " + foreign;
  if (!is_text(begin)) return {};
  const auto line = begin.substr(0, begin.find_first_of("\r\n"));
  const auto tabs = std::ranges::count(line, '\t'), commas = std::ranges::count(line, ',');
  const std::string cells = tabs > 0     ? fmt::format("{} cells between tabs", tabs + 1)
                            : commas > 0 ? fmt::format("{} cells between commas", commas + 1)
                                         : "one cell";
  return fmt::format(
      ": its first line has {}, and a table of coordinates has labels there such as time, LASI_X, "
      "LASI_Y, LASI_Z",
      cells);
}

/// As the reader of its format reads it; `box_m` around its samples where that reader knows it.
Result<data::Trial> read_as_it_is(const std::filesystem::path& path, const MarkerReadOptions& options,
                                  Eigen::AlignedBox3d& box_m) {
  const auto begin = read_plain_begin(path);
  if (!begin) return std::unexpected(begin.error());
  if (begins_keypoints(*begin))
    return fail(
        Code::not_supported,
        fmt::format("{}: holds points in the images of a camera, in pixels, and no positions of markers; "
                    "give it to ik or track with --rig and --images CAMERA=FILE",
                    path.string()));
  const std::string extension = lower_extension(path);
  const MarkerFormat* format = format_of(*begin, extension);
  if (format == nullptr && begin->empty())
    return fail(Code::bad_input, fmt::format("{}: is empty", path.string()));
  if (format == nullptr && is_read(extension))
    return fail(Code::bad_input,
                fmt::format("{}: does not begin as a {} file does", path.string(), extension));
  if (format == nullptr)
    return fail(Code::not_supported,
                fmt::format("{}: {} is not read as a marker file{}; supported are {}", path.string(),
                            named(extension), describe_text(*begin), names_of_read_formats()));
  const bool by_ending = format->begins == nullptr || !format->begins(*begin);
  if (const auto foreign = by_ending ? foreign_text(*begin) : std::string(); !foreign.empty())
    if (auto trial = format->read(path, options, box_m); !trial)
      return fail(Code::not_supported, fmt::format("{}: {}", path.string(), foreign));
  if (format->stores_rate && options.rate_hz != 0.0) {
    // Of a file that cannot be read, the reader's own sentence says more.
    if (auto trial = format->read(path, options, box_m); !trial) return trial;
    return fail(Code::usage,
                fmt::format("{}: the file stores its own rate; a rate (--rate) is given only for {}",
                            path.string(), names_without_rate()));
  }
  return format->read(path, options, box_m);
}

}  // namespace

bool begins_as_markers(const std::filesystem::path& path) {
  const auto begin = read_plain_begin(path);
  return begin && std::ranges::any_of(marker_formats(), [&](const MarkerFormat& f) {
           return f.begins != nullptr && f.begins(*begin);
         });
}

bool may_lack_unit(const std::filesystem::path& path) {
  const auto begin = read_plain_begin(path);
  const MarkerFormat* format = begin ? format_of(*begin, lower_extension(path)) : nullptr;
  return format != nullptr && format->may_lack_unit;
}

bool needs_rate(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const auto begin = read_plain_begin(path);
  if (const MarkerFormat* format = begin ? format_of(*begin, extension) : nullptr)
    return !format->stores_rate;
  // A file that is not there, or not what its ending says: as all files of this ending.
  const auto of_ending = [&](const MarkerFormat& f) { return f.extension == extension; };
  return std::ranges::any_of(marker_formats(), of_ending) &&
         std::ranges::none_of(marker_formats(),
                              [&](const MarkerFormat& f) { return of_ending(f) && f.stores_rate; });
}

Result<data::Trial> read_markers(const std::filesystem::path& path, const MarkerReadOptions& options) {
  Eigen::AlignedBox3d box_m;
  auto trial = read_as_it_is(path, options, box_m);
  if (!trial) return trial;
  trial->markers.time.first_number = trial->first_frame;
  reject_implausible(*trial, box_m);
  return trial;
}

Status check_marker_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const MarkerFormat* format = written_format(extension);
  if (format != nullptr && format->one_file) return {};
  if (format != nullptr)
    return fail(Code::usage,
                fmt::format("{}: a recording of {} is several files, which kinemark convert writes; write "
                            "another format here and convert it",
                            path.string(), format->name));
  const auto written = written_extensions();
  return fail(Code::usage, fmt::format("{}: {} is not written as a marker file; supported are {}",
                                       path.string(), named(extension), join_names(written, written.size())));
}

Status write_markers(const std::filesystem::path& path, const data::Trial& trial,
                     const MarkerWriteOptions& options) {
  if (auto s = check_marker_format(path); !s) return s;
  const MarkerFormat& format = *written_format(lower_extension(path));
  if (options.lost != nullptr) {
    auto parts = lost_in(format, trial);
    options.lost->insert(options.lost->end(), parts.begin(), parts.end());
  }
  return format.write(path, trial, options);
}

Status write_markers(const std::filesystem::path& path, const data::Trial& trial, bool force,
                     const std::string& set, std::vector<std::string>* lost) {
  return write_markers(path, trial, {.force = force, .set = set, .lost = lost});
}

}  // namespace kinemark::io

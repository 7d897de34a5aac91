// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "kinemark/io/file.h"
#include "kinemark/io/keypoints/keypoints_hdf5.h"
#include "kinemark/io/keypoints/keypoints_json.h"
#include "kinemark/io/keypoints/openpose.h"

namespace kinemark::io {
namespace {

/// Text that begins as a document of JSON does; no CSV of points does.
bool begins_json(std::string_view begin) {
  const auto first = begin.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && (begin[first] == '{' || begin[first] == '[');
}

enum class Writer : std::uint8_t { openpose, document, hdf5, csv };

Result<Writer> writer_of(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return Writer::openpose;
  std::array<char, 512> first{};
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  const auto size = file->read_at(0, std::as_writable_bytes(std::span(first)));
  if (!size) return std::unexpected(size.error());
  const std::string_view begin(first.data(), *size);
  if (begin.starts_with("\x89HDF\r\n\x1a\n")) return Writer::hdf5;
  return is_openpose(begin) ? Writer::openpose : begins_json(begin) ? Writer::document : Writer::csv;
}

}  // namespace

/// Whether the third line or the fourth of a table of DeepLabCut says z: points in space, no points in
/// images.
bool has_depth(std::string_view begin) {
  for (int line = 0; line < 4 && !begin.empty(); ++line) {
    const auto cells = begin.substr(0, begin.find('\n'));
    if (cells.starts_with("coords,")) return cells.find(",z") != std::string_view::npos;
    begin.remove_prefix(std::min(cells.size() + 1, begin.size()));
  }
  return false;
}

bool begins_keypoints(std::string_view begin) {
  if (begin.starts_with("scorer,")) return !has_depth(begin);
  if (begin.starts_with("track,frame_idx,")) return true;
  constexpr std::array<std::string_view, 6> kKeys = {"\"people\"",      "\"instance_info\"", "\"meta_info\"",
                                                     "\"annotations\"", "\"keypoints\"",     "\"images\""};
  return begins_json(begin) && std::ranges::any_of(kKeys, [&](std::string_view key) {
           return begin.find(key) != std::string_view::npos;
         });
}

Result<Keypoints> read_keypoints(const std::filesystem::path& path, const KeypointsOptions& options) {
  const auto writer = writer_of(path);
  if (!writer) return std::unexpected(writer.error());
  if (*writer == Writer::openpose) return read_openpose(path, options);
  if (*writer == Writer::csv) return read_keypoints_csv(path, options);
  if (*writer == Writer::hdf5) return read_keypoints_hdf5(path, options);
  const auto text = read_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_keypoints_json(*text, path.string(), options);
}

Result<std::vector<std::filesystem::path>> keypoints_files(const std::filesystem::path& path) {
  const auto writer = writer_of(path);
  if (!writer) return std::unexpected(writer.error());
  if (*writer != Writer::openpose) return std::vector{path};
  const auto frames = openpose_files(path);
  if (!frames) return std::unexpected(frames.error());
  std::vector<std::filesystem::path> files;
  for (const auto& frame : *frames) files.push_back(frame.path);
  return files;
}

}  // namespace kinemark::io

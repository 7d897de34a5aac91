// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>
#include <tuple>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/keypoints/openpose.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = "_keypoints.json";
constexpr std::size_t kMostBytes = 16UL << 20;  // of a frame: some 10,000 people

/// A file of one frame: NAME_NUMBER_keypoints.json.
struct FrameFile {
  std::int64_t number = 0;
  std::string video;  ///< what stands before the number
  fs::path path;
};

/// None for files that are called otherwise.
std::optional<FrameFile> frame_file(const fs::path& path) {
  const std::string name = path.filename().string();
  if (!name.ends_with(kEnding)) return {};
  const auto stem = std::string_view(name).substr(0, name.size() - kEnding.size());
  const auto before = stem.find_last_not_of("0123456789");
  const auto begin = before == std::string_view::npos ? 0 : before + 1;
  FrameFile file{.video = std::string(stem.substr(0, begin)), .path = path};
  const auto [end, error] = std::from_chars(stem.data() + begin, stem.data() + stem.size(), file.number);
  if (begin == stem.size() || error != std::errc()) return {};
  return file;
}

/// Files of frames in a folder, in the order of their numbers.
Result<std::vector<FrameFile>> frame_files(const fs::path& folder) {
  std::vector<FrameFile> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (auto file = frame_file(it->path())) files.push_back(std::move(*file));
  if (error) return fail(Code::io, fmt::format("{}: {}", folder.string(), error.message()));
  std::ranges::sort(files, {}, [](const FrameFile& f) { return std::tie(f.number, f.video, f.path); });
  return files;
}

}  // namespace

Result<std::vector<OpenPoseFile>> openpose_files(const fs::path& path) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  const auto given = is_folder ? std::nullopt : frame_file(path);
  if (!is_folder && !given)
    return fail(Code::bad_input, fmt::format("{}: is not called as a frame of OpenPose is, NAME_NUMBER{}",
                                             path.string(), kEnding));
  const auto beside = is_folder ? path : path.has_parent_path() ? path.parent_path() : fs::path(".");
  auto files = frame_files(beside);
  if (!files) return std::unexpected(files.error());
  if (given) std::erase_if(*files, [&](const FrameFile& f) { return f.video != given->video; });
  if (files->empty())
    return fail(Code::bad_input,
                fmt::format("{}: holds no frames of OpenPose, NAME_NUMBER{}", path.string(), kEnding));
  std::vector<OpenPoseFile> out;
  for (auto& file : *files) {
    if (file.video != files->front().video)
      return fail(Code::bad_input,
                  fmt::format("{}: holds frames of '{}' and of '{}'; give one file of those wanted",
                              path.string(), printable(files->front().video, 60), printable(file.video, 60)));
    out.push_back({.number = file.number, .path = std::move(file.path)});
  }
  return out;
}

Result<Keypoints> read_openpose(const fs::path& path, const KeypointsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  const auto files = openpose_files(path);
  if (!files) return std::unexpected(files.error());
  OpenPoseFrames frames(options);
  for (const auto& file : *files) {
    const auto text = read_text(file.path, kMostBytes);
    if (!text) return std::unexpected(text.error());
    if (auto s = frames.add(file.number, *text); !s) return fail_at(file.path.string(), s.error());
  }
  auto points = frames.finish();
  if (!points) return fail_at(path.string(), points.error());
  return points;
}

}  // namespace kinemark::io

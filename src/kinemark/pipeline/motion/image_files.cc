// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/image_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "kinemark/io/keypoints/keypoints_file.h"
#include "kinemark/io/rig/rig_file.h"

namespace kinemark::pipeline {
namespace {

Result<data::Camera> pinhole_camera(const data::Rig& rig, const ImageFiles& files, const std::string& name) {
  std::string known;
  for (const auto& camera : rig.cameras) {
    if (camera.name == name) {
      if (camera.kind == data::CameraKind::pinhole) return camera;
      return fail(Code::not_supported,
                  fmt::format("{}: camera '{}' is {}; points in pixels need a pinhole camera",
                              files.rig.string(), name, data::to_string(camera.kind)));
    }
    known += (known.empty() ? "" : ", ") + camera.name;
  }
  return fail(Code::bad_input,
              fmt::format("{}: has no camera '{}'; it has {}", files.rig.string(), name, known));
}

}  // namespace

io::KeypointsOptions ImageFiles::points_options() const {
  return {.min_likelihood = min_likelihood, .person = person};
}

Status ImageFiles::check() const {
  if (!any()) return {};
  if (rig.empty()) return fail(Code::usage, "images need the rig of their cameras; give --rig");
  if (cameras.empty())
    return fail(Code::usage, "a rig without images has no effect; give --images CAMERA=FILE");
  std::set<std::string> names;
  for (const auto& [camera, points] : cameras)
    if (!names.insert(camera).second)
      return fail(Code::usage, fmt::format("camera '{}' has two files of images", camera));
  if (!(noise_sd_px > 0.0 && std::isfinite(noise_sd_px)))
    return fail(Code::usage, fmt::format("the image noise is {} px; it must be more than 0", noise_sd_px));
  return points_options().check();
}

std::string describe_images(const ImageFiles& files) {
  return fmt::format("{} cameras, {:g} px", files.cameras.size(), files.noise_sd_px);
}

Result<data::ImageTracks> read_images(const ImageFiles& files, const TimeBase& time) {
  if (auto s = files.check(); !s) return std::unexpected(s.error());
  const auto rig = io::read_rig(files.rig);
  if (!rig) return std::unexpected(rig.error());
  data::ImageTracks tracks;
  tracks.time = time;
  tracks.noise_sd.assign(files.cameras.size(), files.noise_sd_px);
  std::vector<io::Keypoints> points;
  for (const auto& [name, path] : files.cameras) {
    auto camera = pinhole_camera(*rig, files, name);
    if (!camera) return std::unexpected(camera.error());
    tracks.cameras.push_back(std::move(*camera));
    auto read = io::read_keypoints(path, files.points_options());
    if (!read) return std::unexpected(read.error());
    if (read->frames() != time.frames)
      return fail(Code::bad_input, fmt::format("{}: has {} frames; the markers have {}", path.string(),
                                               read->frames(), time.frames));
    for (const auto& point : read->names)
      if (std::ranges::find(tracks.names, point) == tracks.names.end()) tracks.names.push_back(point);
    points.push_back(std::move(*read));
  }
  tracks.image.assign(2 * static_cast<std::size_t>(time.frames) * tracks.cameras.size() * tracks.names.size(),
                      std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < points.size(); ++c)
    for (std::size_t k = 0; k < points[c].names.size(); ++k) {
      const auto m = static_cast<std::size_t>(std::ranges::find(tracks.names, points[c].names[k]) -
                                              tracks.names.begin());
      for (std::int64_t f = 0; f < time.frames; ++f)
        for (const Eigen::Index axis : {0, 1})
          tracks.image[tracks.index(f, c, m) + static_cast<std::size_t>(axis)] = points[c].at(f, k)[axis];
    }
  return tracks;
}

}  // namespace kinemark::pipeline

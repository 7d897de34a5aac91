// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/image_tracks.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::pipeline {

/// Labelled points in the images of calibrated cameras: a rig, and for each camera in use a file of points.
struct ImageFiles {
  /// The points of one camera.
  struct OfCamera {
    std::string camera;            ///< name in the rig
    std::filesystem::path points;  ///< file or folder of labelled points
  };
  std::filesystem::path rig;           ///< rig.toml
  std::vector<OfCamera> cameras;       ///< none: no images
  double noise_sd_px = 1.0;            ///< of a point, per axis; > 0
  double min_likelihood = 0.6;         ///< 0 to 1: less likely points are not seen
  std::optional<std::int64_t> person;  ///< in files of several people; without: the only one

  /// Whether images are to be used.
  [[nodiscard]] bool any() const { return !cameras.empty() || !rig.empty(); }
  /// How the files are read.
  [[nodiscard]] io::KeypointsOptions points_options() const;
  /// Both a rig and cameras, each once; numbers in range.
  [[nodiscard]] Status check() const;
};

/// "2 cameras, 1 px", for the provenance record.
[[nodiscard]] std::string describe_images(const ImageFiles& files);

/// The images as tracks: points of all files, in the order in which they are named first, at the frames of
/// `time`. Every file has exactly as many frames. Cameras that the rig lacks or that are no pinhole cameras,
/// and files that differ in length, are bad input.
[[nodiscard]] Result<data::ImageTracks> read_images(const ImageFiles& files, const TimeBase& time);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/keypoints/internal/point_frames.h"

namespace kinemark::io::internal {

/// Annotations of COCO for the images of a video, piece by piece, in any order of `images`, `annotations` and
/// `categories`.
class CocoVideo {
 public:
  /// `bytes` of the whole document.
  CocoVideo(const KeypointsOptions& options, std::size_t bytes) : frames_(options), bytes_(bytes) {}

  /// Looks at a piece of the document; those of others are passed over.
  [[nodiscard]] Status take(std::string_view key, const nlohmann::json& piece);
  /// Whether there was an image or an annotation.
  [[nodiscard]] bool any() const { return !images_.empty() || !people_.empty(); }
  /// All points: of each image, in the order of the document. Annotations of images that are not there, and
  /// of a second category with points, are Code::bad_input and Code::not_supported.
  [[nodiscard]] Result<Keypoints> finish();

 private:
  [[nodiscard]] Status take_image(const nlohmann::json& image);
  [[nodiscard]] Status take_annotation(const nlohmann::json& annotation);
  [[nodiscard]] Status take_category(const nlohmann::json& category);
  [[nodiscard]] Result<const std::vector<std::string>*> names() const;

  PointFrames frames_;
  std::size_t bytes_;
  std::vector<std::int64_t> images_;                        ///< identifiers, in the order of the document
  std::map<std::int64_t, std::vector<Person>> people_;      ///< of each image
  std::map<std::int64_t, std::vector<std::string>> names_;  ///< of each category with points
  std::vector<std::int64_t> categories_;                    ///< of annotations, each once
};

}  // namespace kinemark::io::internal

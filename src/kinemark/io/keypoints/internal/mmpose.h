// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/keypoints/internal/point_frames.h"

namespace kinemark::io::internal {

/// Predictions of MMPose for a video, piece by piece.
class MmposeVideo {
 public:
  /// `bytes` of the whole document.
  MmposeVideo(const KeypointsOptions& options, std::size_t bytes) : frames_(options), bytes_(bytes) {}

  /// Looks at a piece of the document; those of others are passed over.
  [[nodiscard]] Status take(std::string_view key, const nlohmann::json& piece);
  /// Whether there was a frame.
  [[nodiscard]] bool any() const { return any_; }
  /// All points. Without names in the document: keypoint_0, keypoint_1 and so on.
  [[nodiscard]] Result<Keypoints> finish();

 private:
  [[nodiscard]] Status take_frame(const nlohmann::json& frame);

  PointFrames frames_;
  std::size_t bytes_;
  std::vector<std::string> names_;
  bool any_ = false;
};

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io {

/// Whether a text begins as a frame of OpenPose does: an object with `people` in its first 512 bytes.
[[nodiscard]] bool is_openpose(std::string_view text);

/// Points of OpenPose, a file of JSON for each frame: `pose_keypoints_2d` (BODY_25, COCO or MPI by their
/// number) and, where they are, `hand_left_keypoints_2d`, `hand_right_keypoints_2d` and `face_keypoints_2d`.
class OpenPoseFrames {
 public:
  explicit OpenPoseFrames(const KeypointsOptions& options);  ///< of no frame yet
  OpenPoseFrames(OpenPoseFrames&&) noexcept;                 ///< takes the frames over
  OpenPoseFrames& operator=(OpenPoseFrames&&) noexcept;      ///< takes the frames over
  ~OpenPoseFrames();

  /// The next frame; numbers rise, and frames that are left out show nobody. Anything but such a frame, and
  /// people with other points than those before, are Code::bad_input; points in three dimensions alone, and
  /// several people where none is chosen, Code::not_supported.
  [[nodiscard]] Status add(std::int64_t frame, std::string_view text);
  /// All frames from the first to the last; Code::bad_input where nobody was seen, or where all coordinates
  /// are shares of the image in place of pixels.
  [[nodiscard]] Result<Keypoints> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A frame of a video.
struct OpenPoseFile {
  std::int64_t number = 0;     ///< in its name
  std::filesystem::path path;  ///< NAME_NUMBER_keypoints.json
};

/// The frames of one video by their numbers: of a folder of NAME_NUMBER_keypoints.json, or those beside any
/// one of its files. A folder with files of two NAMEs, or of none, is Code::bad_input; a file chooses its
/// own.
[[nodiscard]] Result<std::vector<OpenPoseFile>> openpose_files(const std::filesystem::path& path);

/// The points of these files. The first frame that is there is frame 0 of the points. Memory: the points and
/// the largest file. docs/formats/keypoints.md
[[nodiscard]] Result<Keypoints> read_openpose(const std::filesystem::path& path,
                                              const KeypointsOptions& options = {});

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"

namespace kinemark::io {

/// Points in the images of one camera as SLEAP and DeepLabCut keep them in HDF5: F frames, P people (tracks,
/// individuals), M points. What a person's points are used for is decided by who asks.
struct PoseTable {
  std::int64_t frames = 0;  ///< F
  std::vector<std::string>
      people;  ///< P, of bytes as the file has them; one without a name where it tells none
  std::vector<std::string> points;  ///< M, likewise
  /// F x P x M x 3: x and y (px) and a score; NaN where not known. A point that a person set by hand, or of a
  /// file without scores, has score 1.
  Array<double> values;

  /// Sizes fit each other.
  [[nodiscard]] Status validate() const;
};

/// Read an analysis file of SLEAP (datasets `tracks` and `node_names`) or a table of DeepLabCut (what pandas
/// writes of a DataFrame with columns scorer, bodyparts, coords, and with individuals where there are
/// several). HDF5 reads in a process of its own, with the limits of read_nwb(). Anything else, tables of
/// single images, frames that are not 0, 1, 2, ...: Code::bad_input; projects of SLEAP (.slp):
/// Code::not_supported; cannot be opened: Code::io. docs/formats/keypoints.md
[[nodiscard]] Result<PoseTable> read_pose_table(const std::filesystem::path& path);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Visual3D text export: five rows of header, one row per frame, one column per component of a signal.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Signals of three angles through time, F frames and S signals, read as orientations of segments in the
/// laboratory: rotation about x, then about the new y, then about the new z (intrinsic X-Y-Z Cardan angles).
struct SegmentOrientations {
  std::vector<std::string> names;  ///< S, the file's signal names
  std::int64_t frames = 0;         ///< F
  Array<double> angles_deg;        ///< F x S x 3, as the file has them; NaN where a cell is missing

  [[nodiscard]] std::int64_t find(std::string_view name) const;  ///< index, or -1
  /// The three angles of a signal in a frame, rad; NaN where missing.
  [[nodiscard]] Eigen::Vector3d angles(std::int64_t frame, std::int64_t signal) const;
  /// Takes directions of the segment to the laboratory; NaN where an angle is missing.
  [[nodiscard]] Eigen::Matrix3d world_from_segment(std::int64_t frame, std::int64_t signal) const;
};

/// What a Visual3D text holds.
struct V3dFile {
  data::Trial trial;                 ///< signals of type LANDMARK and TARGET, in metres
  SegmentOrientations orientations;  ///< signals of type LINK_MODEL_BASED
  std::string recorded_as;           ///< the source file that row 1 names, in UTF-8
};

/// Options of read_v3d().
struct V3dReadOptions {
  double rate_hz = 0.0;  ///< of the rows, which the file does not store; must be given, > 0
};

/// Read a Visual3D text export.
///
/// Tab-separated; ISO-8859-1 and UTF-8 are both understood, in names and paths. Rows 1 to 5 hold, column by
/// column, source file, signal, type, folder and component; row 5 begins with ITEM, and so does every row
/// after it with its number. Columns belong together by signal and type; each such signal needs X, Y and Z
/// once. Lengths are metres, angles degrees. Columns of other types, and of other source files than the
/// first, are not read (warning). A sample is missing when one of its three cells is blank, NaN or infinite
/// or its row ends before it. Zeros are zeros. A blank line ends the data.
///
/// LINK_MODEL_BASED signals are whatever the model of the file computed. That their angles are orientations
/// of segments in the laboratory must be known or tested: rotated into the segment, the vectors between
/// landmarks of one segment are then constant.
///
/// Code::usage without a positive rate; Code::bad_input, with line and column, for anything else that does
/// not fit; Code::io when it cannot be read. O(bytes); memory at most 16 times the text + 125 MB.
[[nodiscard]] Result<V3dFile> read_v3d(const std::filesystem::path& path, const V3dReadOptions& options);

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<V3dFile> parse_v3d(std::string_view text, std::string_view name,
                                        const V3dReadOptions& options);

}  // namespace kinemark::io

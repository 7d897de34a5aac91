// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/c3d/header.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// Points in a row that are all markers.
struct C3dMarkerRun {
  std::int64_t first = 0;  ///< point, from 0
  std::int64_t count = 0;  ///< points
};

/// Contents of a C3D file and their byte positions, derived from header, parameters and file size.
struct C3dLayout {
  Processor processor = Processor::intel;    ///< how numbers are stored
  bool is_float = true;                      ///< 32-bit float samples; else 16-bit integers
  std::int64_t points = 0;                   ///< stored in a frame
  std::int64_t markers = 0;                  ///< M, points that are markers
  std::vector<C3dMarkerRun> runs;            ///< where these are, in order
  std::vector<std::int64_t> channel_points;  ///< the other points, from 0: angles, forces, ...
  std::int64_t frames = 0;                   ///< F, all of which lie in the file
  std::int64_t first_frame = 1;              ///< the file's own number of its first frame
  double rate_hz = 0.0;                      ///< frames a second, > 0
  double scale = 1.0;             ///< size of one integer or residual step, in units of the file, > 0
  double metres_per_unit = 1e-3;  ///< of POINT:UNITS
  std::string units;              ///< POINT:UNITS, or empty

  std::int64_t analog_channels = 0;    ///< K
  std::int64_t samples_per_frame = 0;  ///< S / F, 0 without channels
  bool analog_unsigned = false;        ///< integer samples count from 0 to 65535
  std::vector<double> analog_scale;    ///< K; value = (stored - offset) x scale
  std::vector<double> analog_offset;   ///< K

  std::size_t data_offset = 0;  ///< byte of the first frame
  std::size_t frame_bytes = 0;  ///< 0 when there is neither point nor channel

  /// analog numbers in a frame: channels x samples
  [[nodiscard]] std::int64_t analog_per_frame() const { return analog_channels * samples_per_frame; }
};

/// Derive the layout from header, parameters and file size. Where they disagree, parameters take precedence
/// over the header; where the parameters cannot be right (the frames do not fit into the file) the header is
/// used, and the file size overrides both. Each contradiction adds one sentence to `warnings`.
/// Code::bad_input when no consistent layout is found.
[[nodiscard]] Result<C3dLayout> settle_layout(const C3dHeader& header, const C3dParameters& parameters,
                                              Processor processor, std::size_t file_bytes,
                                              std::vector<std::string>& warnings);

}  // namespace kinemark::io

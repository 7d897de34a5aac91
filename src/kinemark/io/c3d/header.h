// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/c3d/number_format.h"

namespace kinemark::io {

inline constexpr std::size_t kC3dBlock = 512;  ///< bytes; a C3D file counts in blocks, from 1

/// POINT parameter of our own files: a fourth word of 0 means "not measured" even when no sample has a
/// residual, as in a file that was computed throughout.
inline constexpr std::string_view kC3dResidualsParameter = "RESIDUALS_GIVEN";

/// An event of the header: at most 18, four letters each, in seconds after the file's first frame.
struct C3dHeaderEvent {
  std::string label;    ///< four letters at most
  double time_s = 0.0;  ///< after the file's first frame
  bool shown = true;    ///< the file's own flag that the event is to be shown
};

/// The first block of a C3D file, as stored; layout.h resolves its contradictions with the parameters.
struct C3dHeader {
  int parameter_block = 2;             ///< block at which the parameters begin
  int points = 0;                      ///< points in a frame
  int analog_per_frame = 0;            ///< channels x samples
  int first_frame = 1;                 ///< 16 bit
  int last_frame = 0;                  ///< 16 bit
  int max_gap_frames = 0;              ///< longest gap that was interpolated, as the file says
  float scale = 0.0F;                  ///< < 0: numbers are float
  int data_block = 0;                  ///< block at which the samples begin
  int samples_per_frame = 0;           ///< analog
  float rate_hz = 0.0F;                ///< frames a second
  std::vector<C3dHeaderEvent> events;  ///< 18 at most
};

/// True when the first two bytes can be those of a C3D file.
[[nodiscard]] bool is_c3d_header(std::span<const std::byte, kC3dBlock> block);
/// Read the first block; takes every number as it is.
[[nodiscard]] C3dHeader parse_header(std::span<const std::byte, kC3dBlock> block, Processor processor);
/// Events past the eighteenth are left out, labels cut to four letters.
[[nodiscard]] std::array<std::byte, kC3dBlock> encode_header(const C3dHeader& header, Processor processor);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/byte_source.h"
#include "kinemark/io/c3d/decode.h"
#include "kinemark/io/c3d/header.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// Options of read_c3d().
struct C3dReadOptions {
  bool points = true;     ///< coordinates and states; without them the trial has no markers
  bool residuals = true;  ///< residual_m and camera_mask
  bool analog = true;     ///< analog values; names, units and rate come anyway
  int threads = 1;        ///< 0: all cores; the result has the same bits for any number
};

/// A C3D file (Intel, DEC or MIPS; integer or float) whose head has been read and whose frames can be decoded
/// piece by piece, so that hours of data need no more memory than the caller's piece.
class C3dReader {
 public:
  /// Read header and parameters. Code::bad_input when it is not a C3D file or its head is not valid; Code::io
  /// when it cannot be opened.
  static Result<C3dReader> open(const std::filesystem::path& path);
  /// Read header and parameters; Code::bad_input when it is no C3D file or makes no sense.
  static Result<C3dReader> open(std::unique_ptr<ByteSource> source);

  [[nodiscard]] const C3dHeader& header() const { return header_; }              ///< as the file says
  [[nodiscard]] const C3dParameters& parameters() const { return parameters_; }  ///< as the file says
  [[nodiscard]] const C3dLayout& layout() const { return layout_; }              ///< what is true of the file
  /// Everything but samples: names, clock, events, force plates, warnings. Its arrays are empty.
  [[nodiscard]] const data::Trial& description() const { return description_; }

  /// Decode frames [first, first + count), counted from 0, into spans of exactly that size (empty spans are
  /// skipped). A residual of 0 is given as `interpolated`: whether the file has residuals at all is known
  /// only after its last frame (seen.measured over all pieces is 0: it has none, and read_trial() then
  /// calls those samples measured). Range or sizes that do not fit throw ContractError.
  [[nodiscard]] Result<C3dSeen> read(std::int64_t first, std::int64_t count, const C3dFrames& out,
                                     int threads = 1) const;

 private:
  C3dReader() = default;
  std::unique_ptr<ByteSource> source_;
  C3dHeader header_;
  C3dParameters parameters_;
  C3dLayout layout_;
  data::Trial description_;
};

/// The whole file, in metres. See decode_frames() for what is missing, measured or interpolated, and
/// apply_provenance() for what files of kinemark store in addition.
/// Memory: the trial's arrays and half a megabyte per thread. What was seen of the samples goes to `reported`
/// where it is not null.
[[nodiscard]] Result<data::Trial> read_trial(const C3dReader& reader, const C3dReadOptions& options = {},
                                             C3dSeen* reported = nullptr);

/// open() and read_trial() in one call.
[[nodiscard]] Result<data::Trial> read_c3d(const std::filesystem::path& path,
                                           const C3dReadOptions& options = {}, C3dSeen* reported = nullptr);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/number_format.h"

namespace kinemark::io {

/// Options of write_c3d().
struct C3dWriteOptions {
  bool force = false;                        ///< replace a file that exists
  std::string set;                           ///< of files that it belongs to (set_mark()); empty: none
  std::string software = "kinemark";         ///< MANUFACTURER:SOFTWARE, where the trial carries no such group
  std::string units = "mm";                  ///< length unit in the file: "mm", "cm", "m", ...
  Processor processor = Processor::intel;    ///< how numbers are stored
  std::vector<std::string>* lost = nullptr;  ///< gets what did not fit, a sentence each; null: not wanted
  bool integers = false;  ///< 16-bit samples: half the size, rounded to 1/32000 of the largest coordinate
};

/// Write a trial as a C3D file that appears whole or not at all.
///
/// Fourth words: missing and rejected samples -1 with coordinates 0; interpolated, model-filled and upsampled
/// ones 0, which is how C3D says "not measured"; measured ones their residual, rounded to steps of
/// POINT:SCALE from 1 (also the placeholder where residual_m has none) to 255, with the first seven cameras
/// of the mask. A point that would be stored as exactly (0, 0, 0) is moved by 1e-6 units (integers: one
/// step), because readers take the origin for missing. Frames are numbered so that time keeps its zero: frame
/// n is at (n - 1) / rate, rounded to a frame. More than 65535 frames: POINT:FRAMES says 65535, LONG_FRAMES
/// (float), TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD (32 bits) hold the full number. Lists longer than
/// 255 go on in LABELS2 and so on. Which samples were filled how, and their standard deviations, go into a
/// group of our own (add_provenance()), as do filters (add_filters()); samples from before a filter follow as
/// points of their own, "unfiltered_" and the marker's name, in the list POINT:UNFILTERED. Where the
/// parameter section overflows, what is carried for other programs gives way first, then that group.
///
/// Code::bad_input: the trial is not valid, has no frames, or analog samples that do not fill its frames
/// evenly; Code::not_supported: more points, channels or text than the format can count; Code::io: the disk.
[[nodiscard]] Status write_c3d(const std::filesystem::path& path, const data::Trial& trial,
                               const C3dWriteOptions& options = {});

}  // namespace kinemark::io

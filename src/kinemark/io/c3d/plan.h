// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/header.h"
#include "kinemark/io/c3d/parameters.h"
#include "kinemark/io/c3d/writer.h"

namespace kinemark::io {

/// Everything of a C3D file but its samples, decided before the first byte is written.
struct C3dPlan {
  Processor processor = Processor::intel;  ///< how numbers will be stored
  bool integers = false;                   ///< 16-bit integers; false: float
  double units_per_metre = 1000.0;         ///< 1000 for millimetres
  double scale = 1.0;                      ///< of POINT:SCALE, in units; a float's value
  std::int64_t samples_per_frame = 0;      ///< analog samples of a channel in a frame
  std::vector<double> analog_scale;        ///< K; stored = value / scale
  std::vector<double> channel_factor;      ///< C; lengths into the unit of the file, 1 for all others
  std::vector<std::int64_t> unfiltered;    ///< markers whose samples before their filter follow the channels
  C3dHeader header;                        ///< first block of the file
  C3dParameters parameters;                ///< POINT:DATA_START is still 0
};

/// Decide how a trial is written, without the samples from before a filter where `unfiltered` is false;
/// Code::bad_input or Code::not_supported where it has no place in a C3D file.
[[nodiscard]] Result<C3dPlan> plan_c3d(const data::Trial& trial, const C3dWriteOptions& options,
                                       bool unfiltered = true);

}  // namespace kinemark::io

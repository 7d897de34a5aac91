// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Prediction residuals of each phase of a supposed low rate, block by block, and the verdict from them.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/screening/internal/interpolation.h"

namespace kinemark::trajectory::internal {

/// One coordinate of one marker over a complete stretch.
struct Piece {
  std::int64_t first_frame = 0;
  std::vector<double> y;  ///< m
  double step_m = 0.0;    ///< rounding step
};

/// Complete stretches of a marker, all three axes, cut into pieces of at most 2048 frames; evenly spaced ones
/// when they hold more than max_frames frames (0: no limit).
[[nodiscard]] std::vector<Piece> pieces_of(const data::Trajectories& trajectories, std::int64_t marker,
                                           std::int64_t max_frames);

/// Rounding step of numbers: 1st percentile of their first to third differences above 8 single-precision
/// steps. Sorted values alone mislead on a steady ramp; differences of rounded numbers are multiples of the
/// step.
[[nodiscard]] double rounding_step_m(std::span<const double> y);

/// Blocks of 16 knots of one axis, in no order: the informative ones, whose second best phase is above twice
/// the rounding.
struct PhaseTable {
  int factor = 2;
  std::vector<float> log_residual;  ///< rows x factor, log of the RMS in m, phases counted from frame 0
  std::vector<float> log_rounding;  ///< rows
  std::vector<std::int64_t> frame;  ///< rows, centre of the block

  [[nodiscard]] std::size_t rows() const { return log_rounding.size(); }
  void append(const PhaseTable& other);
};

void add_rows(const Piece& piece, data::InterpolationKernel kernel, Knots& knots, PhaseTable& table);

/// Verdict of one table.
struct Candidate {
  int factor = 1, phase = 0;
  data::InterpolationKernel kernel = data::InterpolationKernel::none;
  double ratio = 1.0, agreement = 0.0;
  std::int64_t blocks = 0;
  double residual_m = 0.0, rounding_m = 0.0;
  bool fires = false;
  bool slips = false;  ///< fires only when the phase may change with time

  [[nodiscard]] double above_rounding() const { return residual_m / rounding_m; }
};

/// The phase that wins most blocks, and whether it wins as only an interpolated stream lets it.
[[nodiscard]] Candidate judge(const PhaseTable& table, data::InterpolationKernel kernel);

/// Phase in force along time: path of least cost through the blocks, where each change costs as much as four
/// contradicting blocks. Starts at frame 0. Rows may be in any order.
[[nodiscard]] std::vector<data::PhaseRun> follow_phase(const PhaseTable& table);

}  // namespace kinemark::trajectory::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Prediction residuals of each phase of a supposed low rate, block by block, and the verdict from them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"

namespace kinemark::trajectory::internal {

inline constexpr std::array kKernels{
    data::InterpolationKernel::hold,     data::InterpolationKernel::linear,
    data::InterpolationKernel::spline,   data::InterpolationKernel::catmull_rom,
    data::InterpolationKernel::lagrange, data::InterpolationKernel::pchip,
    data::InterpolationKernel::akima};

/// Knots not used at both ends of a stretch: the end condition of a spline is unknown and its effect decays
/// by 0.27 per knot; the others depend on two neighbours.
[[nodiscard]] constexpr int edge_knots(data::InterpolationKernel kernel) {
  return kernel == data::InterpolationKernel::spline ? 8 : 2;
}
/// Fewest frames of a stretch that is tested.
[[nodiscard]] constexpr int min_stretch(int factor, data::InterpolationKernel kernel) {
  return factor * (kernel == data::InterpolationKernel::spline ? 24 : 12);
}

/// Memory that residuals() reuses.
struct Knots {
  std::vector<double> value, slope, scratch;
};

/// Suppose that samples phase, phase + factor, ... are real: predict those in between and write y minus
/// prediction; `kNotPredicted` at knots and where knots are too few. False when nothing is predicted. O(n).
bool residuals(std::span<const double> y, int factor, int phase, data::InterpolationKernel kernel,
               Knots& knots, std::span<double> out);
inline constexpr double kNotPredicted = 1e300;

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

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion from its file, with the deviations that lie beside it and the rates of its coordinates.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/run_record.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/rates.h"

namespace kinemark::pipeline {

/// A motion with the rates of its coordinates, and what was found out on the way. F frames, n coordinates.
struct RatedMotion {
  data::JointMotion motion;             ///< q, qd, qdd; q_sd where deviations lie beside it
  Array<std::uint8_t> is_filled;        ///< F x n; 1: the file has no number there
  motion::RateErrors errors;            ///< of q, qd and qdd
  std::vector<data::InputFile> inputs;  ///< the motion, and its deviations
  std::vector<std::string> notes;       ///< of the table, and what was filled or taken; a sentence each
};

/// Read Q.mot and, unless it is filtered here, Q_sd.sto beside it; couplings are applied. What the file does
/// not hold, or Q_sd.sto has no number for, is not `determined`.
///
/// Frames that were made between those that were measured, as a motion of an upsampled recording has them,
/// are refused unless it is filtered here: rates would be those of what made them.
///
/// @param cutoff_hz  low-pass of the coordinates beforehand (Butterworth, third order, both ways); 0: none
/// @return  Code::bad_input as the readers, coordinate_rows() and estimate_rates(), and for deviations of
///          another motion; Code::usage for a cut-off beyond half the rate
[[nodiscard]] Result<RatedMotion> read_rated_motion(const std::filesystem::path& path,
                                                    const model::Model& model, double cutoff_hz);

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion from its file, with the deviations that lie beside it and the forces on the body.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/model/model.h"
#include "kinemark/workflow/motion/dynamics.h"

namespace kinemark::pipeline {

/// What workflow::dynamics() and measure_motion() take, named by its files.
struct MotionOfFiles {
  workflow::GivenMotion given;          ///< q_sd where deviations lie beside it; the default of a coordinate
                                        ///< without a column is not `determined`
  std::vector<data::InputFile> inputs;  ///< the motion, its deviations, the forces
  std::vector<std::string> notes;       ///< of the tables, and what was filled or taken; a sentence each
};

/// Read Q.mot, Q_sd.sto beside it unless it is low-passed, and forces where a path is given.
/// @param cutoff_hz  above 0: it is low-passed, and deviations have no use
/// @return  Code::bad_input as the readers and coordinate_rows(), and for deviations of another motion;
///          as io::read_external_forces()
[[nodiscard]] Result<MotionOfFiles> read_motion(const std::filesystem::path& path,
                                                const std::filesystem::path& forces,
                                                const model::Model& model, double cutoff_hz);

}  // namespace kinemark::pipeline

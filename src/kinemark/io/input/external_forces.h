// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::io {

/// Forces that act on the body besides gravity, and the files they come from.
struct ExternalForces {
  data::Wrenches wrenches;                   ///< on the recording's clock
  std::vector<std::filesystem::path> files;  ///< all that were read, the named one first
  std::vector<std::string> warnings;         ///< one sentence each
  std::vector<std::string> contradicted;     ///< as PlateForces::contradicted
};

/// Forces on the body at the frames of `time`: the plates of a .c3d or .mat file, an OpenSim ExternalLoads
/// .xml with its table, a table alone, by the names of its columns (loads_of_columns()), or a .txt of D-Flow.
/// NaN where the file has no data. Another kind of file: Code::usage.
/// @param contact_force_n  of plates, PlateOptions
[[nodiscard]] Result<ExternalForces> read_external_forces(const std::filesystem::path& path,
                                                          const TimeBase& time, double contact_force_n);

/// The forces beside the markers of a text of D-Flow (kForcesOfDFlow), on the frames of its markers.
[[nodiscard]] Result<ExternalForces> read_own_forces(const std::filesystem::path& path, const TimeBase& time,
                                                     double contact_force_n);

}  // namespace kinemark::io

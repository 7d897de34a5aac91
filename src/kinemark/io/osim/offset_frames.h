// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/math/se3.h"

namespace kinemark::io {

/// A frame that a model fixes on a body, as OpenSense's IMUPlacer adds one for each sensor.
struct OffsetFrame {
  std::string name;           ///< "tibia_r_imu"
  int body_idx = 0;           ///< of the description
  math::SE3 body_from_frame;  ///< m
};

/// The frames (PhysicalOffsetFrame) of these names that a model fixes on its bodies, in the order of the
/// names; those that it lacks, that two frames bear or that stand on the ground are left out.
///
/// @param model  what read_osim() made of the same file
[[nodiscard]] Result<std::vector<OffsetFrame>> read_offset_frames(const std::filesystem::path& path,
                                                                  const data::ModelDescription& model,
                                                                  const std::vector<std::string>& names);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Result<std::vector<OffsetFrame>> parse_offset_frames(std::string_view xml,
                                                                   std::string_view name,
                                                                   const data::ModelDescription& model,
                                                                   const std::vector<std::string>& names);

}  // namespace kinemark::io

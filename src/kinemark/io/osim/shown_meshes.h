// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io {

/// The meshes that an OpenSim model shows on its bodies, in the order of the file: "attached_geometry" from
/// 4.0 on, "VisibleObject" with its own scale and pose before, lists of file names before 2.0. What is hidden
/// by itself (display preference 0, not visible) and what is attached to the ground is left out. Their files
/// are not looked at.
///
/// @param model  what read_osim() made of the same file
[[nodiscard]] Result<std::vector<data::ShownMesh>> read_shown_meshes(const std::filesystem::path& path,
                                                                     const data::ModelDescription& model);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Result<std::vector<data::ShownMesh>> parse_shown_meshes(std::string_view xml,
                                                                      std::string_view name,
                                                                      const data::ModelDescription& model);

}  // namespace kinemark::io

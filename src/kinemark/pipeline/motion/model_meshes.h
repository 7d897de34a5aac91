// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The meshes that an .osim names, found, read and made small enough for a page.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/triangle_mesh.h"

namespace kinemark::pipeline {

/// What there is to draw of a model.
struct ModelMeshes {
  std::map<std::string, data::TriangleMesh, std::less<>> of_body;  ///< m, in the axes of the named body
  std::string note;  ///< what was found, what was not, and why; empty: the model names no mesh
};

/// Folders that were given are there; else Code::io in one sentence.
[[nodiscard]] Status check_geometry(std::span<const std::filesystem::path> folders);

/// Meshes of a model's bodies. A file is looked for beside the model, in the folder Geometry there, and then
/// in `folders` in their order, as OpenSim does; where nothing has its name, letters in any case will do. An
/// absolute name is taken as it is. What cannot be found or read is named in the note and not drawn. All
/// meshes together have 12,000 triangles at most; larger ones are made coarser.
///
/// @param osim       the model's file
/// @param model      what read_osim() made of it
/// @param most_read  triangles; after more of them no further file is read
[[nodiscard]] ModelMeshes read_model_meshes(const std::filesystem::path& osim,
                                            const data::ModelDescription& model,
                                            std::span<const std::filesystem::path> folders,
                                            std::size_t most_read = 6'000'000);

}  // namespace kinemark::pipeline

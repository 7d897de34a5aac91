// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Lengths of muscles before and after scaling, which set the lengths of their fibres and tendons.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/muscle_path.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion {

/// Length of a path along its points in the pose of the workspace, m: straight from each point to the next of
/// those whose condition holds, and around the cylinders that it meets, as OpenSim bends it (GeometryPath and
/// WrapCylinder). Spheres, ellipsoids and tori are left out. After model::kinematics().
[[nodiscard]] double path_length(const model::Model& model, const model::Workspace& w,
                                 const data::MusclePath& path);

/// The path with its points and frames stretched by the factors of their bodies (one per body of the
/// description, along its axes), as OpenSim's ScaleTool stretches them.
[[nodiscard]] data::MusclePath scale_path(const data::MusclePath& path,
                                          std::span<const Eigen::Vector3d> factors);

/// Ratio of the lengths after and before, of every path, each model in its default pose; 1 for a path that
/// had no length.
///
/// @param before   that the paths and factors belong to
/// @param after    scaled; may have more bodies behind those of `before`
/// @param factors  one per body of `before`
[[nodiscard]] Result<std::vector<data::PathScale>> scale_paths(const data::ModelDescription& before,
                                                               const data::ModelDescription& after,
                                                               std::span<const data::MusclePath> paths,
                                                               std::span<const Eigen::Vector3d> factors);

}  // namespace kinemark::motion

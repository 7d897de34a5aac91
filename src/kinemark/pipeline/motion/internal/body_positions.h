// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::pipeline::internal {

/// Where the bodies of a model are in a motion of it. A body ends where the bodies that it carries begin (the
/// middle of them), one that carries none as far beyond its mass centre as that lies from its origin. Bodies
/// without mass or length are left out, unless they have a mesh.
[[nodiscard]] report::SceneBodies body_positions(const model::Model& model, const data::JointMotion& motion,
                                                 const ModelMeshes& meshes = {});

}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/data/counts.h"
#include "kinemark/stages/report/figures/space_drawing.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/common/study_figure.h"

namespace kinemark::studies {

/// World of the rig (X right, Y up, Z towards the cameras) in axes of a report::SpaceDrawing, seen from the
/// cameras at azimuth 0.
[[nodiscard]] Eigen::Matrix3Xd upright(const Eigen::Matrix3Xd& world);

/// A signer of lines, whose arm hangs at this shoulder (m, world): head, trunk, the other shoulder. To make
/// an arm recognised as one; nothing is measured of it.
void draw_signer(report::SpaceDrawing& scene, const Eigen::Vector3d& shoulder);

/// Figure 1: what the rig consists of, with the values of this one, and where the LEDs sit.
[[nodiscard]] StudyFigure rig_components(const simulation::PhysicalRig& rig,
                                         const simulation::RigScene& scene, const data::Counts& counts);

}  // namespace kinemark::studies

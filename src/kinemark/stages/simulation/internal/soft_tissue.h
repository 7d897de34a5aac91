// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/internal/segments.h"
#include "kinemark/stages/simulation/subject_options.h"

namespace kinemark::simulation::internal {

/// See soft_tissue_rms_m(). M numbers, m.
[[nodiscard]] Eigen::VectorXd tissue_amplitudes(const Segments& segments);

/// Displacement of every marker in the frame of its segment's first body, m: one 3 x F matrix per marker.
///
/// Per marker: a field linear in the angles of the segment's joints (mean removed, over their standard
/// deviations, random directions) plus 9 Hz oscillations that die away in 0.1 s after each impact, half as
/// large as the field at its start (no impacts in tai_chi). A share of the variance is common to the segment.
/// Then the mean over the recording is taken out and the whole scaled to the marker's amplitude. q is n x F,
/// coordinates through time; impact_hz the rate of impacts.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> tissue_displacements(const Segments& segments,
                                                                 const Eigen::MatrixXd& q, double impact_hz,
                                                                 const SubjectOptions& options);

}  // namespace kinemark::simulation::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/hold_hinges.h"

#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {
namespace {

constexpr double kHeldGain = 1e-3;  // chi-square of a fit's last step

}  // namespace

void hold_hinges(const ChainSamples& samples, const std::vector<HingeAxis>& hinges, FittedChain& fit) {
  for (const HingeAxis& hinge : hinges) {
    const double above = hinge.in_parent.dot(joint_from_markers(fit.chain, hinge.joint, true));
    const double below = hinge.in_child.dot(joint_from_markers(fit.chain, hinge.joint, false));
    const double along = -0.5 * (above + below);
    move_joint(fit.chain, hinge.joint, true, along * hinge.in_parent);
    move_joint(fit.chain, hinge.joint, false, along * hinge.in_child);
  }
  PosedFrames frames = first_poses(samples, fit.chain, fit.frames, fit.marker_weight, fit.noise_sd_m, 25);
  GeometryFit geometry(fit.chain, samples, frames, fit.noise_sd_m);
  geometry.hold(hinges);
  const auto done = [&](int, double gain_m2) {
    return gain_m2 < kHeldGain * fit.noise_sd_m * fit.noise_sd_m;
  };
  geometry.run(20, {}, done);
  if (fit.robust_dof > 0.0) {
    geometry.reweigh(fit.marker_weight, fit.robust_dof, fit.noise_sd_m);
    geometry.run(10, {}, done);
  }
  fit.geometry_covariance =
      fit.geometry_covariance_scale * fit.noise_sd_m * fit.noise_sd_m * geometry.covariance(fit.noise_sd_m);
}

}  // namespace kinemark::skeleton::articulated

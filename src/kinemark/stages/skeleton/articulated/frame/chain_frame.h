// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is known of one frame of a chain.
#pragma once

#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Of what a joint's centre is the mean, with the variance of all.
enum class Gathered : char {
  none,       ///< it is that of the best mode
  positions,  ///< several modes
  valley,     ///< the profile of the best mode, which is not Gaussian
};

/// One of the poses that fit a frame.
struct ChainMode {
  ChainPose pose;
  double cost = 0.0;             ///< m^2, weighted
  double weight = 0.0;           ///< share of the probability, 0 to 1
  std::vector<Vector3d> centre;  ///< joints, m
};

/// All that is known of a frame.
struct ChainFrame {
  std::vector<data::CentreState> state;  ///< per joint: undetermined, ambiguous or determined
  std::vector<Vector3d> centre;          ///< per joint, of the best mode (or see gathered), m
  std::vector<Matrix3d> covariance;      ///< per joint, m^2, with the geometry's own part
  std::vector<Matrix3d> own_covariance;  ///< per joint, m^2, geometry held
  std::vector<Matrix3d> information;     ///< per joint, 1/m^2, geometry held; any rank
  std::vector<ChainMode> modes;          ///< best first; one when no other was looked for
  int mode_count = 0;                    ///< entries of `modes` in use
  std::vector<Gathered> gathered;        ///< per joint
  int seen = 0;
};

}  // namespace kinemark::skeleton::articulated

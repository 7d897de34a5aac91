// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Chains of straight segments with markers around them, for the tests of this folder and of topology.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton::testing {

/// Rotation of each segment against the one before.
enum class Rotations : std::uint8_t { anywhere, cone, hinge };

struct ChainSetup {
  std::int64_t frames = 300;
  std::vector<double> lengths_m{0.150, 0.160};
  int per_segment = 3;
  double stagger_m = 0.02;
  Rotations rotations = Rotations::anywhere;
  double range_rad = 1.0;  ///< whole range of cones (about any axis) and hinges (about x)
  double noise_sd_m = 0.0;
  double missing = 0.0;
  std::uint64_t seed = 1;
};

struct TestChain {
  data::Trajectories markers;
  data::SegmentLayout layout;
  std::vector<Eigen::Matrix3Xd> centres;       ///< one 3 x F a joint, m
  std::vector<Eigen::Matrix3Xd> x_in_segment;  ///< from the segment's upper end, z along the bone
  std::vector<std::vector<Eigen::Matrix3d>> world_from_segment;  ///< S x F
};

[[nodiscard]] TestChain make_chain(const ChainSetup& setup);

/// RMS of |centre - truth| over the frames that have one; share of frames that do.
struct CentreError {
  double rms_m = 0.0, share = 0.0;
};
[[nodiscard]] CentreError centre_error(const data::Skeleton& skeleton, const TestChain& chain,
                                       std::int64_t joint);

}  // namespace kinemark::skeleton::testing
